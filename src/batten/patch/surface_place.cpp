#include "batten/patch/surface_place.h"

#include <array>

#include "batten/patch/corner_parameters.h"
#include "batten/patch/halving.h"

namespace batten {

namespace {

/// A child's frame in its parent: where its first corner lies, and its sides as steps in (u, v).
struct ChildFrame {
  std::array<double, 2> origin;
  std::array<double, 2> u;
  std::array<double, 2> v;
};

/// Quads: of the child at each corner, whose first side leads along the corner's half-edge.
constexpr ChildFrame kQuadFrames[4] = {{{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}},
                                       {{1.0, 0.0}, {0.0, 0.5}, {-0.5, 0.0}},
                                       {{1.0, 1.0}, {-0.5, 0.0}, {0.0, -0.5}},
                                       {{0.0, 1.0}, {0.0, -0.5}, {0.5, 0.0}}};
/// Triangles: likewise, and of the middle one, whose corners lie on the three sides in turn.
constexpr ChildFrame kTriangleFrames[4] = {{{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}},
                                           {{1.0, 0.0}, {-0.5, 0.5}, {-0.5, 0.0}},
                                           {{0.0, 1.0}, {0.0, -0.5}, {0.5, -0.5}},
                                           {{0.5, 0.0}, {0.0, 0.5}, {-0.5, 0.5}}};

const ChildFrame& frame_of(bool quads, Index child) { return (quads ? kQuadFrames : kTriangleFrames)[child]; }

/// The child, by its number in the face, that has a place.
Index child_at(bool quads, const SurfacePlace& place) {
  double u = place.u;
  double v = place.v;
  return halve(quads, u, v).child;
}

/// The frame's sides, as columns, undone.
Eigen::Matrix2d into_child(const ChildFrame& frame) {
  const double determinant = frame.u[0] * frame.v[1] - frame.u[1] * frame.v[0];
  Eigen::Matrix2d inverse;
  inverse << frame.v[1], -frame.v[0], -frame.u[1], frame.u[0];
  return inverse / determinant;
}

}  // namespace

SurfacePlace place_of_vertex(const Topology& base, Index vertex) {
  const Index half_edge = base.vertex_half_edge(vertex);
  const Index face = base.face(half_edge);
  const auto [u, v] = corner_parameters(base.face_size(face), half_edge - base.face_begin(face));
  return {face, u, v};
}

SurfacePlace refined_place(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() == 4;
  const Index child = child_at(quads, place);
  const ChildFrame& frame = frame_of(quads, child);
  const Eigen::Vector2d at = into_child(frame) * Eigen::Vector2d(place.u - frame.origin[0], place.v - frame.origin[1]);
  return {4 * place.face + child, at[0], at[1]};
}

Eigen::Matrix2d refined_parameters(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() == 4;
  return into_child(frame_of(quads, child_at(quads, place)));
}

SurfacePlace coarser_place(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() == 4;
  const ChildFrame& frame = frame_of(quads, place.face % 4);
  return {place.face / 4, frame.origin[0] + place.u * frame.u[0] + place.v * frame.v[0],
          frame.origin[1] + place.u * frame.u[1] + place.v * frame.v[1]};
}

}  // namespace batten
