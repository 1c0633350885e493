#include "batten/patch/poles.h"

#include <algorithm>

#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

Index mean_count(const Topology& topology) { return topology.uniform_face_size() == 3 ? 1 : 2; }

/// The faces around a vertex where its fan is closed and none of its edges is sharp, otherwise 0.
Index smooth_face_count(const Topology& topology, Index vertex) {
  Index count = 0;
  Index h = topology.vertex_half_edge(vertex);
  const Index start = h;
  do {
    if (topology.edge_sharpness(topology.edge(h)) > 0.0F) return 0;
    h = topology.twin(topology.previous(h));
    ++count;
  } while (h >= 0 && h != start);
  return h == start ? count : 0;
}

}  // namespace

Poles::Poles(const Topology& topology, const Scheme& scheme)
    : means_(mean_count(topology)), first_(topology.vertex_count()) {
  if (scheme.crease_method == CreaseMethod::Chaikin && topology.has_creases()) return;
  Buffer<Index> faces(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index h = 0; h < topology.half_edge_count(); ++h) ++faces[topology.origin(h)];
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (faces[v] < kFewestFaces || vertex_sharpness(topology, scheme, v) > 0.0F) continue;
    if (smooth_face_count(topology, v) == faces[v]) add(v, faces[v]);
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

}  // namespace batten
