#include "batten/adaptive/butterfly_points.h"

#include <cmath>
#include <string>
#include <unordered_map>

#include "batten/error.h"
#include "batten/limit/butterfly_fan.h"
#include "batten/refine/child_topology.h"
#include "batten/tessellate/lattice_walk.h"

namespace batten {

namespace {

/// One level of refinement as a connectivity without stored tables.
struct Level {
  TessellationLayout layout;
  LatticeTags tags;
  LatticeWalk walk;
  Level(const Topology& base, const Scheme& scheme, int level)
      : layout(base, false, level), tags(lattice_tags(base, scheme, level)), walk(base, layout, tags) {}
};

/// A point of the lattice at the coarsest level that contains it.
struct LatticePlace {
  int level;
  Index face;
  Index i;
  Index j;
};

LatticePlace coarsest(LatticePlace place) {
  for (; place.level > 0 && place.i % 2 == 0 && place.j % 2 == 0; --place.level) {
    place.i /= 2;
    place.j /= 2;
  }
  return place;
}

/// Throws Error(BadArgument) for a place that refinement does not reach.
LatticePlace lattice_place(const Topology& base, const SurfacePlace& place) {
  constexpr int kMostLevels = ButterflyPoints::kMostLevels;
  constexpr double kSteps = Index{1} << kMostLevels;
  const double i = kSteps * place.u;
  const double j = kSteps * place.v;
  const bool inside = place.face >= 0 && place.face < base.face_count() && i >= 0 && j >= 0 && i + j <= kSteps;
  if (!inside || i != std::floor(i) || j != std::floor(j)) {
    throw Error(ErrorCode::BadArgument, "a place of a Butterfly surface is a face of the mesh and a point that " +
                                            std::to_string(kMostLevels) + " levels of refinement reach in it");
  }
  return {kMostLevels, place.face, static_cast<Index>(i), static_cast<Index>(j)};
}

}  // namespace

struct ButterflyPoints::Parts {
  Topology base;
  Scheme scheme;
  Values control;
  ButterflyMasks masks;
  ButterflyTangents tangents;
  std::vector<std::unique_ptr<Level>> levels;
  std::unordered_map<std::uint64_t, Eigen::Vector3d> known;

  Parts(const Topology& topology, const Scheme& scheme_in, ConstValuesRef control_in)
      : base(topology), scheme(scheme_in), control(control_in), masks(scheme), tangents(scheme) {}

  const Level& level(int number) {
    while (static_cast<int>(levels.size()) <= number) {
      levels.push_back(std::make_unique<Level>(base, scheme, static_cast<int>(levels.size())));
    }
    return *levels[number];
  }

  Eigen::Vector3d point(const LatticePlace& anywhere) {
    const LatticePlace place = coarsest(anywhere);
    const Level& own = level(place.level);
    const std::int64_t number = own.layout.number(base, place.face, place.i, place.j);
    if (place.level == 0) return control.row(number).transpose();
    constexpr int kLevelBits = 5;
    const std::uint64_t key = (static_cast<std::uint64_t>(number) << kLevelBits) | static_cast<unsigned>(place.level);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    // The midpoint of an edge of the level above, taken in an upright triangle.
    const LatticeWalk& walk = level(place.level - 1).walk;
    const int side = place.i % 2 == 0 ? 2 : (place.j % 2 == 0 ? 0 : 1);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    ButterflyRules(walk, masks)
        .visit({place.face, place.i / 2, place.j / 2, false, side},
               [&](const LatticeWalk::Vertex& from, double weight) {
                 sum += weight * point({place.level - 1, from.face, from.i, from.j});
               });
    known.emplace(key, sum);
    return sum;
  }

  /// The normal on the side of the place's face.
  Eigen::Vector3d normal(const LatticePlace& anywhere) {
    const LatticePlace place = coarsest(anywhere);
    const LatticeWalk& walk = level(place.level).walk;
    const ButterflySide<LatticeWalk> side = side_of(walk, walk.outgoing(place.face, place.i, place.j));
    const auto point_of = [&](const LatticeWalk::Vertex& at) { return point({place.level, at.face, at.i, at.j}); };
    const ButterflyTangentMasks* made = side.has_masks() ? &tangents.make(side.shape(), side.triangles()) : nullptr;
    return ButterflyNormal(walk, masks, point_of)(side, made);
  }
};

ButterflyPoints::ButterflyPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control) {
  require_triangles(topology, scheme);
  require_vertex_rows(topology, control);
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "points have three columns");
  parts_ = std::make_unique<Parts>(topology, scheme, control);
}

ButterflyPoints::~ButterflyPoints() = default;

void ButterflyPoints::evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points,
                               Eigen::Ref<Points> normals) {
  for (std::size_t p = 0; p < places.size(); ++p) {
    const LatticePlace at = lattice_place(parts_->base, places[p]);
    const auto row = static_cast<Eigen::Index>(p);
    points.row(row) = parts_->point(at).transpose();
    normals.row(row) = parts_->normal(at).transpose();
  }
}

void ButterflyPoints::evaluate(std::span<const SurfacePlace> places, Eigen::Ref<Points> points) {
  for (std::size_t p = 0; p < places.size(); ++p) {
    points.row(static_cast<Eigen::Index>(p)) = parts_->point(lattice_place(parts_->base, places[p])).transpose();
  }
}

}  // namespace batten
