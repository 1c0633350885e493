#include "batten/fit/mesh_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"
#include "batten/mesh/vertex_measure.h"
#include "batten/mesh/vertex_normals.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"

namespace batten {

namespace {

/// The triangles of a mesh and how much area they reach together, one after the other.
struct SampledTriangles {
  std::vector<std::array<Index, 3>> corners;  ///< vertices
  std::vector<Index> faces;
  std::vector<double> reached;
};

Eigen::RowVector3d area_normal(const Mesh& mesh, const std::array<Index, 3>& t) {
  const Eigen::RowVector3d a = mesh.points.row(t[0]);
  return 0.5 * (mesh.points.row(t[1]) - a).cross(mesh.points.row(t[2]) - a);
}

SampledTriangles sampled_triangles(const Mesh& mesh, const Topology& topology) {
  SampledTriangles triangles;
  std::vector<std::array<Index, 3>> places;
  double sum = 0.0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (topology.is_hole(f)) continue;
    places.clear();
    triangulate_face(mesh, f, places);
    for (const std::array<Index, 3>& place : places) {
      std::array<Index, 3> t{};
      for (int c = 0; c < 3; ++c) t[c] = mesh.face_vertices[mesh.face_offsets[f] + place[c]];
      sum += area_normal(mesh, t).norm();
      triangles.corners.push_back(t);
      triangles.faces.push_back(f);
      triangles.reached.push_back(sum);
    }
  }
  return triangles;
}

Eigen::RowVector3d unit_normal(const Mesh& mesh, Index face) {
  return face_normal(mesh, face).normalized().transpose();
}

/// An edge to be sampled, and in how many parts.
struct SampledEdge {
  Index edge;
  Index first;  ///< its first sample
  Index count;
};

/// The edges of one kind and the samples that come before each.
std::vector<SampledEdge> sampled_edges(const Mesh& mesh, const Topology& topology, SampleKind kind, double spacing,
                                       double sharp_angle, Index& next) {
  std::vector<SampledEdge> edges;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    const bool boundary = topology.is_boundary_edge(e);
    if (boundary != (kind == SampleKind::Boundary)) continue;
    if (!boundary && !(topology.edge_sharpness(e) > 0.0F)) {
      if (!(sharp_angle < std::numbers::pi)) continue;
      const double turn =
          angle_between(unit_normal(mesh, topology.face(h)), unit_normal(mesh, topology.face(topology.twin(h))));
      if (!(turn > sharp_angle)) continue;
    }
    const double length = (mesh.points.row(topology.origin(h)) - mesh.points.row(topology.destination(h))).norm();
    const auto count = static_cast<Index>(std::lround(std::min(length / spacing, 1e6)));
    edges.push_back({e, next, std::max<Index>(1, count)});
    next += edges.back().count;
  }
  return edges;
}

void take_edges(MeshSamples& samples, const Mesh& mesh, const Topology& topology, SampleKind kind,
                const std::vector<SampledEdge>& edges) {
  for (const SampledEdge& edge : edges) {
    const Index h = topology.edge_half_edge(edge.edge);
    const Eigen::RowVector3d from = mesh.points.row(topology.origin(h));
    const Eigen::RowVector3d to = mesh.points.row(topology.destination(h));
    Eigen::RowVector3d normal = unit_normal(mesh, topology.face(h));
    if (kind == SampleKind::Crease) normal += unit_normal(mesh, topology.face(topology.twin(h)));
    for (Index k = 0; k < edge.count; ++k) {
      samples.points.row(edge.first + k) = from + (k + 0.5) / edge.count * (to - from);
      samples.normals.row(edge.first + k) = normal.normalized();
      samples.kinds[edge.first + k] = kind;
      samples.faces[edge.first + k] = topology.face(h);
    }
  }
}

void take_faces(MeshSamples& samples, const Mesh& mesh, const SampledTriangles& triangles, Index count,
                const Progress& progress) {
  // The powers of the inverse of 1.3247..., the root of x^3 = x + 1.
  constexpr double kFirstStep = 0.7548776662466927;
  constexpr double kSecondStep = 0.5698402909980532;
  const double area = triangles.reached.back();
  const auto take = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const double reached = (static_cast<double>(i) + 0.5) / count * area;
      const auto found = std::upper_bound(triangles.reached.begin(), triangles.reached.end() - 1, reached);
      const std::ptrdiff_t triangle = found - triangles.reached.begin();
      double u = std::fmod(0.5 + kFirstStep * static_cast<double>(i + 1), 1.0);
      double v = std::fmod(0.5 + kSecondStep * static_cast<double>(i + 1), 1.0);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const std::array<Index, 3>& t = triangles.corners[triangle];
      samples.points.row(i) =
          (1.0 - u - v) * mesh.points.row(t[0]) + u * mesh.points.row(t[1]) + v * mesh.points.row(t[2]);
      samples.normals.row(i) = area_normal(mesh, t).normalized();
      samples.kinds[i] = SampleKind::Face;
      samples.faces[i] = triangles.faces[triangle];
    }
  };
  parallel_for(count, take, 1024, progress);
}

}  // namespace

MeshSamples sample_mesh(const Mesh& mesh, Index count, const MeshSampleOptions& options, const Progress& progress) {
  constexpr Index kMost = 100000000;
  if (count < 1 || count > kMost) throw Error(ErrorCode::BadArgument, "a mesh is sampled at 1 to 100,000,000 places");
  if (!(options.sharp_angle >= 0.0 && options.sharp_angle <= std::numbers::pi))
    throw Error(ErrorCode::BadArgument, "the angle of sharp edges is between 0 and pi");
  const Topology topology(mesh, progress_within(progress, 0.0, 0.3));
  const SampledTriangles triangles = sampled_triangles(mesh, topology);
  if (triangles.reached.empty() || !(triangles.reached.back() > 0.0) || !std::isfinite(triangles.reached.back()))
    throw Error(ErrorCode::BadArgument, "a mesh without area cannot be sampled");
  MeshSamples samples;
  samples.spacing = std::sqrt(triangles.reached.back() / count);
  Index next = count;
  const double angle = options.sharp_angle;
  const std::vector<SampledEdge> creases =
      sampled_edges(mesh, topology, SampleKind::Crease, samples.spacing, angle, next);
  const std::vector<SampledEdge> boundaries =
      sampled_edges(mesh, topology, SampleKind::Boundary, samples.spacing, angle, next);
  report_progress(progress, 0.5);
  samples.points.resize(next, 3);
  samples.normals.resize(next, 3);
  samples.kinds.resize(static_cast<std::size_t>(next));
  samples.faces.resize(static_cast<std::size_t>(next));
  take_faces(samples, mesh, triangles, count, progress_within(progress, 0.5, 1.0));
  take_edges(samples, mesh, topology, SampleKind::Crease, creases);
  take_edges(samples, mesh, topology, SampleKind::Boundary, boundaries);
  return samples;
}

Index sample_count(Index vertices) {
  constexpr Index kLeast = 10000;
  constexpr Index kMost = 200000;
  constexpr Index kOfVertex = 12;
  return std::max(kLeast, std::clamp(vertices, Index{1}, kMost / kOfVertex) * kOfVertex);
}

PointCloud cloud_of_mesh(const Mesh& mesh, Index vertices) {
  if (mesh.face_count() > 0) {
    MeshSamples samples = sample_mesh(mesh, sample_count(vertices));
    return {std::move(samples.points), std::move(samples.normals)};
  }
  PointCloud cloud{mesh.points, Points(0, 3)};
  if (states_normals(mesh)) {
    cloud.normals = stated_normals(mesh);
    cloud.normals.rowwise().normalize();
  }
  return cloud;
}

}  // namespace batten
