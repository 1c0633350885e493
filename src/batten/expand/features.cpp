#include "batten/expand/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/sides.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// The unit normals and areas of the faces.
struct FaceNormals {
  Points normals;
  Eigen::VectorXd areas;
};

FaceNormals face_normals(const Topology& topology, ConstValuesRef points) {
  FaceNormals faces{Points(topology.face_count(), 3), Eigen::VectorXd(topology.face_count())};
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t f = begin; f < end; ++f) {
      const Eigen::Vector3d normal = face_normal(topology, points, static_cast<Index>(f));
      const double length = normal.norm();
      faces.areas[f] = 0.5 * length;
      faces.normals.row(f) = (length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero()).transpose();
    }
  });
  return faces;
}

/// One pass: averages each normal with those of its neighbours, weighted by how similar they are.
Points smoothed(const Topology& topology, const FaceNormals& faces, double likeness) {
  Points next(faces.normals.rows(), 3);
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Eigen::RowVector3d own = faces.normals.row(f);
      Eigen::RowVector3d sum = faces.areas[f] * own;
      for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
        const Index twin = topology.twin(h);
        if (twin < 0 || topology.edge_sharpness(topology.edge(h)) > 0.0F) continue;
        const Index g = topology.face(twin);
        const double apart = (faces.normals.row(g) - own).squaredNorm();
        sum += faces.areas[g] * std::exp(-apart / (2.0 * likeness * likeness)) * faces.normals.row(g);
      }
      const double length = sum.norm();
      next.row(f) = length > 0.0 ? Eigen::RowVector3d(sum / length) : own;
    }
  });
  return next;
}

}  // namespace

std::vector<Crease> find_features(const Topology& topology, ConstValuesRef points, const FeatureOptions& options,
                                  const Progress& progress) {
  require_vertex_rows(topology, points);
  if (points.cols() != 3) throw Error(ErrorCode::BadShape, "sharp edges need points of three columns");
  if (!(options.degrees > 0.0) || !(options.degrees < 180.0))
    throw Error(ErrorCode::BadArgument, "the angle of a sharp edge must be between 0 and 180 degrees");
  const double angle = options.degrees * std::numbers::pi / 180.0;
  FaceNormals faces = face_normals(topology, points);
  // Half of the distance between two unit normals at that angle. Across a sharp edge the weight is e^-2 or less.
  const double likeness = std::sin(0.5 * angle);
  for (int pass = 0; pass < options.normal_passes; ++pass) {
    report_progress(progress, static_cast<double>(pass) / options.normal_passes);
    faces.normals = smoothed(topology, faces, likeness);
  }
  const double least_cosine = std::cos(angle);
  std::vector<Index> sharp;
  DisjointSets sets(static_cast<std::size_t>(topology.vertex_count()));
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_sharpness(e) > 0.0F) continue;
    const Index h = topology.edge_half_edge(e);
    const Index f = topology.face(h);
    const Index g = topology.face(topology.twin(h));
    if (!(faces.areas[f] > 0.0) || !(faces.areas[g] > 0.0)) continue;
    if (faces.normals.row(f).dot(faces.normals.row(g)) >= least_cosine) continue;
    sharp.push_back(e);
    sets.join(topology.origin(h), topology.destination(h));
  }
  std::vector<int> sizes(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (const Index e : sharp) ++sizes[sets.root(topology.origin(topology.edge_half_edge(e)))];
  std::vector<Crease> creases;
  for (const Index e : sharp) {
    const Index h = topology.edge_half_edge(e);
    if (sizes[sets.root(topology.origin(h))] >= options.least_edges)
      creases.push_back({topology.origin(h), topology.destination(h), kInfiniteSharpness});
  }
  return creases;
}

}  // namespace batten
