#include "batten/nearest/surface_side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "batten/patch/corner_parameters.h"

namespace batten {

namespace {

constexpr double kOnSide = 1e-13;  ///< places on the third side of a triangle lie on it to rounding only

/// The fraction of side `side` at which the place lies, or -1 if it is not on the side.
double fraction_on_side(Index corner_count, Index side, const SurfacePlace& place) {
  const auto [start_u, start_v] = corner_parameters(corner_count, side);
  const auto [end_u, end_v] = corner_parameters(corner_count, (side + 1) % corner_count);
  const double u = place.u - start_u;
  const double v = place.v - start_v;
  const double du = end_u - start_u;
  const double dv = end_v - start_v;
  if (std::abs(u * dv - v * du) > kOnSide) return -1.0;
  return std::clamp((u * du + v * dv) / (du * du + dv * dv), 0.0, 1.0);
}

}  // namespace

SurfaceSide side_of(const LimitSurface& surface, const Eigen::Vector3d& query, const NearestPoint& nearest) {
  const Topology& base = surface.base();
  const Index corners = base.uniform_face_size() == 3 ? 3 : 4;
  const Eigen::Vector3d away = query - nearest.point;
  double best = 0.0;
  const auto look = [&](const SurfacePlace& place) {
    const Jet jet = surface.jet(place);
    const double seen = jet.du.cross(jet.dv).stableNormalized().dot(away);
    if (std::abs(seen) > std::abs(best)) best = seen;
  };
  look(nearest.place);
  const Index first = base.face_begin(nearest.place.face);
  for (Index c = 0; c < corners; ++c) {
    const double t = fraction_on_side(corners, c, nearest.place);
    if (t < 0.0) continue;
    if (t == 0.0) {
      base.for_each_outgoing(base.origin(first + c), [&](Index h) {
        const Index face = base.face(h);
        const Index corner = h - base.face_begin(face);
        const std::array<double, 2> at = corner_parameters(corners, corner);
        look({face, at[0], at[1]});
      });
    }
    const Index twin = base.twin(first + c);
    if (twin < 0 || t == 0.0 || t == 1.0) continue;
    const Index face = base.face(twin);
    const Index corner = twin - base.face_begin(face);
    const auto [start_u, start_v] = corner_parameters(corners, corner);
    const auto [end_u, end_v] = corner_parameters(corners, (corner + 1) % corners);
    const double v = t * start_v + (1.0 - t) * end_v;
    const double u = t * start_u + (1.0 - t) * end_u;
    look({face, corners == 3 ? std::min(u, 1.0 - v) : u, v});
  }
  return best < 0.0 ? SurfaceSide::Inside : SurfaceSide::Outside;
}

bool encloses_space(const Topology& topology) {
  if (topology.face_count() == 0) return false;
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.twin(h) < 0 || topology.is_hole(topology.face(h))) return false;
  }
  return true;
}

}  // namespace batten
