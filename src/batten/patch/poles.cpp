#include "batten/patch/poles.h"

#include <algorithm>
#include <string>

#include "batten/error.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

Index mean_count(const Topology& topology) { return topology.uniform_face_size() == 3 ? 1 : 2; }

Buffer<Index> face_counts(const Topology& topology) {
  Buffer<Index> faces(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index h = 0; h < topology.half_edge_count(); ++h) ++faces[topology.origin(h)];
  return faces;
}

/// Chaikin's rule looks beyond rings.
bool may_have_poles(const Topology& topology, const Scheme& scheme) {
  return scheme.crease_method != CreaseMethod::Chaikin || !topology.has_creases();
}

/// The faces around a vertex where its fan is closed and none of its edges is sharper than given, otherwise 0.
Index smooth_face_count(const Topology& topology, Index vertex, float sharpness) {
  Index count = 0;
  Index h = topology.vertex_half_edge(vertex);
  const Index start = h;
  do {
    if (topology.edge_sharpness(topology.edge(h)) > sharpness) return 0;
    h = topology.twin(topology.previous(h));
    ++count;
  } while (h >= 0 && h != start);
  return h == start ? count : 0;
}

}  // namespace

Poles::Poles(const Topology& topology, const Scheme& scheme)
    : means_(mean_count(topology)), first_(topology.vertex_count()) {
  if (!may_have_poles(topology, scheme)) return;
  const Buffer<Index> faces = face_counts(topology);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (faces[v] < kFewestFaces || vertex_sharpness(topology, scheme, v) > 0.0F) continue;
    if (smooth_face_count(topology, v, 0.0F) == faces[v]) add(v, faces[v]);
  }
}

Poles::Poles(const Topology& topology, Index vertex, Index faces)
    : means_(mean_count(topology)), first_(topology.vertex_count()) {
  add(vertex, faces);
}

void Poles::add(Index vertex, Index faces) {
  places_.emplace(vertex, static_cast<Index>(vertices_.size()));
  vertices_.push_back(vertex);
  faces_.push_back(faces);
}

Index Poles::most_faces() const { return empty() ? 0 : *std::max_element(faces_.begin(), faces_.end()); }

Values Poles::with_means(const Topology& topology, const Values& values) const {
  Values all(values.rows() + static_cast<Eigen::Index>(means_) * static_cast<Eigen::Index>(vertices_.size()),
             values.cols());
  all.topRows(values.rows()) = values;
  for (const Index pole : vertices_) {
    auto means = all.middleRows(first_mean(pole), means_);
    means.setZero();
    topology.for_each_outgoing(pole, [&](Index h) {
      Index side = topology.next(h);
      for (Index m = 0; m < means_; ++m, side = topology.next(side)) means.row(m) += values.row(topology.origin(side));
    });
    means /= faces(pole);
  }
  return all;
}

void require_narrow_sharp_fans(const Topology& topology, const Scheme& scheme, int steps) {
  const auto fading = static_cast<float>(steps);  // sharpness falls by one a step
  const Buffer<Index> faces = face_counts(topology);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (faces[v] <= kMostSharpFaces) continue;
    const bool fades = may_have_poles(topology, scheme) && vertex_sharpness(topology, scheme, v) <= fading;
    if (fades && smooth_face_count(topology, v, fading) == faces[v]) continue;
    throw Error(ErrorCode::TooLarge,
                "vertex " + std::to_string(v) + " has " + std::to_string(faces[v]) +
                    " faces and is at a boundary or crease, or a corner: the surface around such a vertex is cut into "
                    "pieces for at most " +
                    std::to_string(kMostSharpFaces) + "; divide the fan");
  }
}

}  // namespace batten
