#include "batten/fit/relaxed_surface.h"

#include <cstddef>
#include <optional>

#include "batten/limit/limit_matrix.h"

namespace batten {

namespace {

/// Where a control point inside the surface relaxes to: the mean of its neighbours, on sharp lines that of those on the
/// lines.
struct RelaxedPlace {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d line = Eigen::RowVector3d::Zero();  ///< where one line passes, from one of the two to the other
  Index sharp = 0;                                       ///< neighbours on lines
};
std::optional<RelaxedPlace> relaxed_place(const Topology& topology, const Values& control, Index v) {
  if (topology.is_boundary_vertex(v)) return std::nullopt;
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d sharp_sum = Eigen::RowVector3d::Zero();
  RelaxedPlace result;
  Index count = 0;
  topology.for_each_outgoing(v, [&](Index h) {
    const Eigen::RowVector3d neighbour = control.row(topology.destination(h));
    sum += neighbour;
    ++count;
    if (!(topology.edge_sharpness(topology.edge(h)) > 0.0F)) return;
    sharp_sum += neighbour;
    result.line = neighbour - result.line;
    ++result.sharp;
  });
  const bool ends = result.sharp < 2;
  result.mean = (ends ? sum : sharp_sum) / static_cast<double>(ends ? count : result.sharp);
  return result;
}

}  // namespace

Values relaxed_along(const Topology& topology, const Scheme& scheme, Values control, const Buffer<std::uint8_t>& held) {
  constexpr int kSweeps = 2;
  constexpr double kPart = 0.5;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Values before = control;
    const Values normals = limit_normals(topology, scheme, before).vertices;
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (held[static_cast<std::size_t>(v)] == 0) continue;
      const std::optional<RelaxedPlace> place = relaxed_place(topology, before, v);
      if (!place || topology.vertex_sharpness(v) > 0.0F) continue;
      const Eigen::RowVector3d move = kPart * (place->mean - before.row(v));
      if (place->sharp == 0) {
        control.row(v) += move - move.dot(normals.row(v)) * normals.row(v);
      } else if (place->sharp == 2 && place->line.squaredNorm() > 0.0) {
        control.row(v) += move.dot(place->line) / place->line.squaredNorm() * place->line;
      }
    }
  }
  return control;
}

Values evened_out(const Topology& topology, const Values& control, const Buffer<std::uint8_t>& faces, double part) {
  Buffer<std::uint8_t> corners(static_cast<std::size_t>(control.rows()), 0);
  for (Index f = 0; f < static_cast<Index>(faces.size()); ++f) {
    if (faces[f] == 0) continue;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) corners[topology.origin(h)] = 1;
  }
  Values moved = control;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (corners[v] == 0) continue;
    if (const std::optional<RelaxedPlace> place = relaxed_place(topology, control, v))
      moved.row(v) += part * (place->mean - moved.row(v));
  }
  return moved;
}

}  // namespace batten
