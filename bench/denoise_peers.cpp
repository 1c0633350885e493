/// Noise removal from surfaces of known shape beside VTK's and CGAL's methods: prints the table of docs/denoise.md.
///
/// Batten chooses its passes by the noise that it measures. The others get the parameters with the least error, which
/// only someone who knows the true shape could choose. Every result is scaled to the volume of the noisy mesh.
#include <CGAL/Polygon_mesh_processing/smooth_shape.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/bilateral_smooth_point_set.h>
#include <CGAL/property_map.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

#include "batten/expand/denoise.h"
#include "batten/expand/volume.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"

namespace {

using batten::Index;
using batten::Mesh;
using batten::Points;
using batten::Topology;
using Kernel = CGAL::Simple_cartesian<double>;

constexpr double kTube = 0.4;

struct Shape {
  const char* name;
  Mesh mesh;
  std::function<double(const Eigen::Vector3d&)> distance;
};

Mesh sphere(int levels) {
  Mesh mesh = batten::icosahedron();
  const batten::Scheme scheme{batten::SchemeKind::Loop};
  const batten::RefinedSurface refined = batten::refine(Topology(mesh), scheme, mesh.points, levels);
  mesh = batten::mesh_from_topology(refined.topology);
  mesh.points = refined.values;
  mesh.points.rowwise().normalize();
  return mesh;
}

std::vector<Shape> shapes() {
  return {{"sphere", sphere(4), [](const Eigen::Vector3d& p) { return p.norm() - 1.0; }},
          {"torus", batten::triangulated(batten::torus(100, 50)),
           [](const Eigen::Vector3d& p) { return std::hypot(std::hypot(p[0], p[1]) - 1.0, p[2]) - kTube; }}};
}

double mean_edge(const Topology& topology, const Points& points) {
  double sum = 0.0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    sum += (points.row(topology.origin(h)) - points.row(topology.destination(h))).norm();
  }
  return sum / topology.edge_count();
}

double error(const Shape& shape, const Points& points) {
  double sum = 0.0;
  for (Index v = 0; v < points.rows(); ++v) sum += std::pow(shape.distance(points.row(v).transpose()), 2);
  return std::sqrt(sum / static_cast<double>(points.rows()));
}

/// Scales about the plain centroid.
Points at_volume(const Topology& topology, Points points, double volume) {
  const double factor = std::cbrt(volume / batten::component_volumes(topology, points).sum());
  const Eigen::RowVector3d centre = points.colwise().mean();
  points = ((points.rowwise() - centre) * factor).rowwise() + centre;
  return points;
}

Points taubin(const Mesh& mesh, int iterations, double pass_band) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Index v = 0; v < mesh.vertex_count(); ++v) points->InsertNextPoint(mesh.points.row(v).data());
  vtkNew<vtkCellArray> faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const vtkIdType corners[3] = {mesh.face_vertices[3 * f], mesh.face_vertices[3 * f + 1],
                                  mesh.face_vertices[3 * f + 2]};
    faces->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(faces);
  vtkNew<vtkWindowedSincPolyDataFilter> filter;
  filter->SetInputData(data);
  filter->SetNumberOfIterations(iterations);
  filter->SetPassBand(pass_band);
  filter->NormalizeCoordinatesOn();
  filter->FeatureEdgeSmoothingOff();
  filter->Update();
  Points result(mesh.vertex_count(), 3);
  for (Index v = 0; v < mesh.vertex_count(); ++v) filter->GetOutput()->GetPoint(v, result.row(v).data());
  return result;
}

/// The points after each of `rounds` rounds.
void bilateral(const Mesh& mesh, unsigned neighbours, double angle, int rounds,
               const std::function<void(const Points&)>& visit) {
  using Pair = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  const Topology topology(mesh);
  const batten::Values normals = batten::limit_normals(topology, {batten::SchemeKind::Loop}, mesh.points).vertices;
  std::vector<Pair> pairs;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    pairs.emplace_back(Kernel::Point_3(mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2)),
                       Kernel::Vector_3(normals(v, 0), normals(v, 1), normals(v, 2)));
  }
  for (int round = 0; round < rounds; ++round) {
    CGAL::bilateral_smooth_point_set<CGAL::Sequential_tag>(
        pairs, neighbours,
        CGAL::parameters::point_map(CGAL::First_of_pair_property_map<Pair>())
            .normal_map(CGAL::Second_of_pair_property_map<Pair>())
            .sharpness_angle(angle));
    Points points(mesh.vertex_count(), 3);
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      points.row(v) << pairs[v].first.x(), pairs[v].first.y(), pairs[v].first.z();
    visit(points);
  }
}

Points curvature_flow(const Mesh& mesh, double time, unsigned iterations) {
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    surface.add_vertex(Kernel::Point_3(mesh.points(v, 0), mesh.points(v, 1), mesh.points(v, 2)));
  using Vertex = CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    surface.add_face(Vertex(mesh.face_vertices[3 * f]), Vertex(mesh.face_vertices[3 * f + 1]),
                     Vertex(mesh.face_vertices[3 * f + 2]));
  }
  CGAL::Polygon_mesh_processing::smooth_shape(surface, time, CGAL::parameters::number_of_iterations(iterations));
  Points points(mesh.vertex_count(), 3);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Kernel::Point_3& p = surface.point(Vertex(v));
    points.row(v) << p.x(), p.y(), p.z();
  }
  return points;
}

}  // namespace

int main() {
  std::printf(
      "| shape | noise | before | Batten `--auto` | Batten, best | VTK, Taubin's (windowed sinc), as it comes | VTK, "
      "best | CGAL, bilateral | "
      "CGAL, curvature flow |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Shape& shape : shapes()) {
    const Topology topology(shape.mesh);
    const double edge = mean_edge(topology, shape.mesh.points);
    for (const double share : {0.05, 0.2, 0.4}) {
      Mesh noisy = shape.mesh;
      std::mt19937 random(1);
      std::normal_distribution<double> normal(0.0, share * edge);
      for (double& coordinate : noisy.points.reshaped()) coordinate += normal(random);
      const double volume = batten::component_volumes(topology, noisy.points).sum();
      const auto judged = [&](const Points& points) {
        return error(shape, at_volume(topology, points, volume)) / edge;
      };
      batten::DenoiseOptions options;
      options.automatic = true;
      const double ours = judged(batten::denoise(noisy, {batten::SchemeKind::Loop}, options).points);
      double best = 1e9;
      for (options.automatic = false, options.m = 0; options.m <= 4; options.m += 2) {
        for (options.passes = 4; options.passes <= 4096; options.passes *= 2)
          best = std::min(best, judged(batten::denoise(noisy, {batten::SchemeKind::Loop}, options).points));
      }
      const double vtk_default = judged(taubin(noisy, 20, 0.1));
      double vtk = 1e9;
      for (const int iterations : {10, 20, 40, 100}) {
        for (const double band : {0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4})
          vtk = std::min(vtk, judged(taubin(noisy, iterations, band)));
      }
      double bilateral_error = 1e9;
      for (const unsigned neighbours : {12U, 24U, 48U}) {
        for (const double angle : {25.0, 60.0}) {
          bilateral(noisy, neighbours, angle, 8,
                    [&](const Points& points) { bilateral_error = std::min(bilateral_error, judged(points)); });
        }
      }
      double flow = 1e9;
      for (const double time : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
        for (const unsigned iterations : {1U, 3U, 10U})
          flow = std::min(flow, judged(curvature_flow(noisy, time, iterations)));
      }
      std::printf("| %s, %d vertices | %.2g | %.3f | **%.3f** | %.3f | %.3f | %.3f | %.3f | %.3f |\n", shape.name,
                  noisy.vertex_count(), share, error(shape, noisy.points) / edge, ours, best, vtk_default, vtk,
                  bilateral_error, flow);
      std::fflush(stdout);
    }
  }
  return 0;
}
