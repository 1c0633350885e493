#include "batten/patch/surface_place.h"

#include <array>

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

}  // namespace

SurfacePlace refined_place(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() == 4;
  double u = place.u;
  double v = place.v;
  const int child = halve(quads, u, v).child;
  const ChildFrame& frame = (quads ? kQuadFrames : kTriangleFrames)[child];
  const double x = place.u - frame.origin[0];
  const double y = place.v - frame.origin[1];
  const double determinant = frame.u[0] * frame.v[1] - frame.u[1] * frame.v[0];
  return {4 * place.face + child, (x * frame.v[1] - y * frame.v[0]) / determinant,
          (y * frame.u[0] - x * frame.u[1]) / determinant};
}

SurfacePlace coarser_place(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() == 4;
  const ChildFrame& frame = (quads ? kQuadFrames : kTriangleFrames)[place.face % 4];
  return {place.face / 4, frame.origin[0] + place.u * frame.u[0] + place.v * frame.v[0],
          frame.origin[1] + place.u * frame.u[1] + place.v * frame.v[1]};
}

}  // namespace batten
