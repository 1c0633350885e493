#include "batten/surface/curvature.h"

#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// A child's place in its base face: the corner where its first half-edge starts, and its two sides from there.
struct Frame {
  Eigen::Vector2d origin{0.0, 0.0};
  Eigen::Vector2d u{1.0, 0.0};
  Eigen::Vector2d v{0.0, 1.0};

  Eigen::Vector2d corner(Index c, bool quads) const {
    if (c == 0) return origin;
    if (c == 1) return origin + u;
    return quads && c == 2 ? Eigen::Vector2d(origin + u + v) : Eigen::Vector2d(origin + v);
  }
};

/// Refinement's children: one at each corner, and Loop's one in the middle. All numbers are dyadic, so exact.
Frame child_of(const Frame& parent, Index child, bool quads) {
  const Index corners = quads ? 4 : 3;
  Frame frame;
  if (child == corners) {  // from the middle of the first side to those of the second and the third
    frame.origin = parent.origin + 0.5 * parent.u;
    frame.u = 0.5 * parent.v;
    frame.v = 0.5 * (parent.v - parent.u);
    return frame;
  }
  frame.origin = parent.corner(child, quads);
  frame.u = 0.5 * (parent.corner((child + 1) % corners, quads) - frame.origin);
  frame.v = 0.5 * (parent.corner((child + corners - 1) % corners, quads) - frame.origin);
  return frame;
}

/// Steps from the base to the refined mesh; -1: from the refined mesh to the base.
int levels_between(const Topology& base, const Topology& refined) {
  if (refined.half_edge_count() == base.face_count() && refined.face_count() < base.face_count()) return -1;
  std::int64_t faces = base.face_count();
  int levels = 0;
  while (faces > 0 && faces < refined.face_count()) {
    faces *= 4;
    ++levels;
  }
  if (faces == refined.face_count()) return levels;
  throw Error(ErrorCode::BadShape, "a mesh of " + std::to_string(refined.face_count()) +
                                       " faces is no refinement of the surface's base, which has " +
                                       std::to_string(base.face_count()));
}

SurfacePlace corner_place(Index face, Index corner, int levels, bool quads) {
  Frame frame;
  for (int level = levels - 1; level >= 0; --level) frame = child_of(frame, (face >> (2 * level)) & 3, quads);
  const Eigen::Vector2d at = frame.corner(corner, quads);
  return {face >> (2 * levels), at.x(), at.y()};
}

/// In place of NaN at a vertex: the mean over its neighbours that have a number.
double mean_around(const Topology& topology, const Scalars& field, Index vertex) {
  double sum = 0.0;
  int count = 0;
  topology.for_each_outgoing(vertex, [&](Index h) {
    const double value = field[topology.destination(h)];
    if (std::isnan(value)) return;
    sum += value;
    ++count;
  });
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Buffer<SurfacePlace> vertex_places(const LimitSurface& surface, const Topology& refined) {
  const Topology& base = surface.base();
  const bool quads = base.uniform_face_size() != 3;
  const int levels = levels_between(base, refined);
  Buffer<SurfacePlace> places(static_cast<std::size_t>(refined.vertex_count()));
  parallel_for(refined.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      const Index h = refined.vertex_half_edge(v);
      if (h < 0) {
        places[v] = {-1, 0.0, 0.0};
      } else if (levels < 0) {
        places[v] = {h, 0.0, 0.0};  // quad h of the first refinement starts at the origin of half-edge h
      } else {
        const Index face = refined.face(h);
        places[v] = corner_place(face, h - refined.face_begin(face), levels, quads);
      }
    }
  });
  return places;
}

Curvature limit_curvature(const LimitSurface& surface, const Topology& refined) {
  const Buffer<SurfacePlace> places = vertex_places(surface, refined);
  const double none = std::numeric_limits<double>::quiet_NaN();
  Curvature exact{Scalars::Constant(refined.vertex_count(), none), Scalars::Constant(refined.vertex_count(), none)};
  parallel_for(refined.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      if (places[v].face < 0) continue;
      const PointCurvature curvature = curvature_of(surface.jet(places[v]));
      exact.mean[v] = curvature.mean;
      exact.gaussian[v] = curvature.gaussian;
    }
  });
  Curvature filled = exact;
  for (Index v = 0; v < refined.vertex_count(); ++v) {
    if (places[v].face < 0 || !std::isnan(exact.mean[v])) continue;
    filled.mean[v] = mean_around(refined, exact.mean, v);
    filled.gaussian[v] = mean_around(refined, exact.gaussian, v);
  }
  return filled;
}

}  // namespace batten
