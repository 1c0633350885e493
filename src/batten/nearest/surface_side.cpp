#include "batten/nearest/surface_side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace batten {

namespace {

constexpr double kOnSide = 1e-13;  ///< the third side of a triangle is met to rounding

struct CornerPlaces {
  std::array<double, 4> u;
  std::array<double, 4> v;
  Index count;
};
constexpr CornerPlaces kQuad{{0.0, 1.0, 1.0, 0.0}, {0.0, 0.0, 1.0, 1.0}, 4};
constexpr CornerPlaces kTriangle{{0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}, 3};

/// The fraction of side `corner` at which the place lies, or -1 where it is not on it.
double fraction_on_side(const CornerPlaces& corners, Index corner, const SurfacePlace& place) {
  const Index next = (corner + 1) % corners.count;
  const double u = place.u - corners.u[corner];
  const double v = place.v - corners.v[corner];
  const double du = corners.u[next] - corners.u[corner];
  const double dv = corners.v[next] - corners.v[corner];
  if (std::abs(u * dv - v * du) > kOnSide) return -1.0;
  return std::clamp((u * du + v * dv) / (du * du + dv * dv), 0.0, 1.0);
}

}  // namespace

SurfaceSide side_of(const LimitSurface& surface, const Eigen::Vector3d& query, const NearestPoint& nearest) {
  const Topology& base = surface.base();
  const CornerPlaces& corners = base.uniform_face_size() == 3 ? kTriangle : kQuad;
  const Eigen::Vector3d away = query - nearest.point;
  double best = 0.0;
  const auto look = [&](const SurfacePlace& place) {
    const Jet jet = surface.jet(place);
    const double seen = jet.du.cross(jet.dv).stableNormalized().dot(away);
    if (std::abs(seen) > std::abs(best)) best = seen;
  };
  look(nearest.place);
  const Index first = base.face_begin(nearest.place.face);
  for (Index c = 0; c < corners.count; ++c) {
    const double t = fraction_on_side(corners, c, nearest.place);
    if (t < 0.0) continue;
    if (t == 0.0) {
      base.for_each_outgoing(base.origin(first + c), [&](Index h) {
        const Index face = base.face(h);
        const Index corner = h - base.face_begin(face);
        look({face, corners.u[corner], corners.v[corner]});
      });
    }
    const Index twin = base.twin(first + c);
    if (twin < 0 || t == 0.0 || t == 1.0) continue;
    const Index face = base.face(twin);
    const Index corner = twin - base.face_begin(face);
    const Index next = (corner + 1) % corners.count;
    const double v = t * corners.v[corner] + (1.0 - t) * corners.v[next];
    const double u = t * corners.u[corner] + (1.0 - t) * corners.u[next];
    look({face, corners.count == 3 ? std::min(u, 1.0 - v) : u, v});
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
