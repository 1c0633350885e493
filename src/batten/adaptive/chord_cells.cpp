#include "batten/adaptive/chord_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "batten/adaptive/chord_bound.h"
#include "batten/error.h"
#include "batten/mesh/segment.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/corner_parameters.h"

namespace batten {

namespace {

using Point = Eigen::Vector3d;
using CornerPoints = std::array<Point, 4>;

/// The number of levels examined below an irregular cell before the hull of the control points is used as a bound.
/// There the hull is about a tenth of the cell's own deviation.
constexpr int kLookAhead = 3;

/// What one more level shows of a cell.
struct Expansion {
  std::array<CellNet, 4> children;
  std::array<Point, 4> middles;  ///< of the sides
  Point centre;
};

/// A flag says what becomes of a cell.
constexpr std::uint8_t kMet = 0;    ///< a leaf within the tolerance
constexpr std::uint8_t kCut = 1;    ///< cut into four
constexpr std::uint8_t kUnmet = 2;  ///< a leaf of max_level beyond the tolerance

/// Visits the cells of base faces depth first. Each thread uses its own object.
class CellWalk {
 public:
  CellWalk(const CellNets& nets, const LimitSurface& surface, const CellForest& forest, const ChordRule& rule)
      : nets_(nets),
        surface_(surface),
        forest_(forest),
        rule_(rule),
        corners_(nets.quads() ? 4 : 3),
        levels_(static_cast<std::size_t>(CellForest::kMostLevels + kLookAhead) + 4) {}

  /// Appends a flag for each cell, depth first.
  void walk(Index face, const CornerPoints& corners, Buffer<std::uint8_t>& flags) {
    nets_.root(face, root_);
    visit(root_, corners, curve_sides(face), flags);
  }
  bool exceeds(Index face, const CornerPoints& corners) {
    nets_.root(face, root_);
    return beyond(root_, corners, curve_sides(face));
  }
  std::int64_t leaves() const { return leaves_; }

 private:
  CurveSides curve_sides(Index face) const {
    const Topology& base = nets_.base();
    CurveSides curves = 0;
    for (int s = 0; s < corners_; ++s) {
      const Index h = base.face_begin(face) + s;
      if (base.edge_sharpness(base.edge(h)) > 0.0F) curves |= 1U << s;
      const bool at_hole = base.twin(h) >= 0 && forest_.is_left_out(base.face(base.twin(h)));
      const auto folds = [&](Index v) { return !base.is_boundary_vertex(v) && base.vertex_face_count(v) == 2; };
      if (at_hole || folds(base.origin(h)) || folds(base.destination(h))) curves |= 17U << s;
    }
    return curves;
  }
  CurveSides child_curves(CurveSides curves, int child) const {
    if (child == corners_) return 0;
    const CurveSides own = 1U << child | 1U << (child + corners_ - 1) % corners_;
    return curves & (own | own << 4);
  }
  CornerPoints child_corners(const CornerPoints& corners, const Expansion& expansion, int child) const {
    CornerPoints result = corners;
    for (int k = 0; k < corners_; ++k) {
      const int next = k + 1 == corners_ ? 0 : k + 1;
      if (child == corners_) {
        result[k] = expansion.middles[next];
      } else if (k != child) {
        const int after = child + 1 == corners_ ? 0 : child + 1;
        result[k] = k == after ? expansion.middles[child] : next == child ? expansion.middles[k] : expansion.centre;
      }
    }
    return result;
  }

  double patch_bound(const CellNet& net, CurveSides curves) const {
    return nets_.quads() ? quad_chord_bound(net.points.data(), curves)
                         : triangle_chord_bound(net.points.data(), curves);
  }
  Point between(const CellNet& net, double u, double v) const {
    const double size = std::ldexp(net.turned ? -1.0 : 1.0, -net.level);
    return surface_.jet({net.face, net.u + size * u, net.v + size * v}).point;
  }
  void expand(const CellNet& net, Expansion& expansion) const;
  double deviation(const CornerPoints& corners, const Expansion& expansion, CurveSides curves) const;
  double centre_deviation(const CellNet& net, const CornerPoints& corners, const Expansion& expansion) const;
  double hull_bound(const CellNet& net, CurveSides curves) const;
  double inner_bound(const CornerPoints& corners, CurveSides curves, int look_ahead, std::size_t depth);
  double bound(const CellNet& net, const CornerPoints& corners, CurveSides curves, int look_ahead, std::size_t depth);
  bool beyond(const CellNet& net, const CornerPoints& corners, CurveSides curves);
  void visit(const CellNet& net, const CornerPoints& corners, CurveSides curves, Buffer<std::uint8_t>& flags);

  const CellNets& nets_;
  const LimitSurface& surface_;
  const CellForest& forest_;
  const ChordRule& rule_;
  int corners_;
  CellNet root_;
  std::vector<Expansion> levels_;  ///< of the cells from the root to the current one, and of the levels examined ahead
  std::int64_t leaves_ = 0;
};

/// The points come from children that are patches, at no cost, or otherwise from the surface.
void CellWalk::expand(const CellNet& net, Expansion& expansion) const {
  nets_.children(net, expansion.children);
  const auto is_patch = [&](int child) { return expansion.children[child].kind == CellNet::Kind::Patch; };
  for (int s = 0; s < corners_; ++s) {
    const int next = s + 1 == corners_ ? 0 : s + 1;
    if (is_patch(s)) {
      expansion.middles[s] = nets_.patch_corner(expansion.children[s], next);
    } else if (is_patch(next)) {
      expansion.middles[s] = nets_.patch_corner(expansion.children[next], s);
    } else {
      const std::array<double, 2> a = corner_parameters(corners_, s);
      const std::array<double, 2> b = corner_parameters(corners_, next);
      expansion.middles[s] = between(net, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]));
    }
  }
  if (corners_ == 3) return;
  for (int k = 0; k < 4; ++k) {
    if (!is_patch(k)) continue;
    expansion.centre = nets_.patch_corner(expansion.children[k], (k + 2) & 3);
    return;
  }
  expansion.centre = between(net, 0.5, 0.5);
}

/// The distance of the points one level deeper from the cell's own faces, for either way to cut the cell in two.
double CellWalk::deviation(const CornerPoints& corners, const Expansion& expansion, CurveSides curves) const {
  const Point normal = (corners_ == 4 ? (corners[2] - corners[0]).cross(corners[3] - corners[1])
                                      : (corners[1] - corners[0]).cross(corners[2] - corners[0]))
                           .normalized();
  const auto stray = [&](const Point& p, const Point& a, const Point& b, bool whole) {
    if (whole || normal.squaredNorm() == 0.0) return distance_to_segment(p, a, b);
    return std::abs(normal.dot(p - 0.5 * (a + b)));
  };
  double worst = 0.0;
  for (int s = 0; s < corners_; ++s) {
    const Point& b = corners[s + 1 == corners_ ? 0 : s + 1];
    worst = std::max(worst, stray(expansion.middles[s], corners[s], b, (curves >> s & 1U) != 0));
  }
  if (corners_ == 3) return worst;
  return std::max({worst, stray(expansion.centre, corners[0], corners[2], false),
                   stray(expansion.centre, corners[1], corners[3], false)});
}

/// The three quads around a triangle's centre are not its children; this is their distance from the children.
double CellWalk::centre_deviation(const CellNet& net, const CornerPoints& corners, const Expansion& expansion) const {
  if (corners_ == 4) return 0.0;
  const std::array<Point, 4>& middles = expansion.middles;
  const Point normal = (middles[1] - middles[0]).cross(middles[2] - middles[0]).normalized();
  const Point centre = between(net, 1.0 / 3.0, 1.0 / 3.0);
  const auto height = [&](const Point& difference) {
    return normal.squaredNorm() > 0.0 ? std::abs(normal.dot(difference)) : difference.norm();
  };
  double worst = height(centre - (middles[0] + middles[1] + middles[2]) / 3.0);
  for (int k = 0; k < 3; ++k) {
    const Point crossing = 0.25 * corners[k] + 0.75 * centre;
    worst = std::max(worst, height(crossing - 0.5 * (middles[k] + middles[(k + 2) % 3])));
  }
  return worst;
}

/// The greatest height of the control points over the cell's plane, which bounds the surface and faces on it.
double CellWalk::hull_bound(const CellNet& net, CurveSides curves) const {
  const auto point = [&](int i) -> Point { return net.points.row(i).transpose(); };
  const Point normal = (corners_ == 4 ? (point(2) - point(0)).cross(point(3) - point(1))
                                      : (point(1) - point(0)).cross(point(2) - point(0)))
                           .normalized();
  if (normal.squaredNorm() == 0.0 || (curves & kEndSides) != 0)
    return (net.points.rowwise() - net.points.row(0)).rowwise().norm().maxCoeff();
  const Eigen::VectorXd heights = (net.points.rowwise() - net.points.row(0)) * normal;
  return heights.maxCoeff() - heights.minCoeff();
}

/// The largest bound of the children in levels_[depth].
double CellWalk::inner_bound(const CornerPoints& corners, CurveSides curves, int look_ahead, std::size_t depth) {
  double worst = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Expansion& expansion = levels_[depth];
    worst = std::max(worst, bound(expansion.children[k], child_corners(corners, expansion, k), child_curves(curves, k),
                                  look_ahead - 1, depth + 1));
  }
  return worst;
}

/// A bound for the distance of a cell's surface from faces over it: the distance of the children's faces plus the
/// children's own bound.
double CellWalk::bound(const CellNet& net, const CornerPoints& corners, CurveSides curves, int look_ahead,
                       std::size_t depth) {
  if (net.kind == CellNet::Kind::Patch) return patch_bound(net, curves);
  if (net.kind == CellNet::Kind::Ring && look_ahead <= 0) return hull_bound(net, curves);
  expand(net, levels_[depth]);
  const double own = deviation(corners, levels_[depth], curves);
  return own + inner_bound(corners, curves, look_ahead, depth);
}

/// True if the cell is beyond the tolerance. For an irregular cell, levels_ then holds its children.
bool CellWalk::beyond(const CellNet& net, const CornerPoints& corners, CurveSides curves) {
  const auto depth = static_cast<std::size_t>(net.level);
  if (net.kind == CellNet::Kind::Patch) {
    // Quads within a cell are half as wide; those of a triangle extend from a corner to the centre, up to two thirds.
    const double shrunk = !rule_.quartered ? 1.0 : corners_ == 4 ? 4.0 : 2.0;
    return patch_bound(net, curves) > rule_.tolerance * shrunk;
  }
  expand(net, levels_[depth]);
  if (rule_.quartered) {
    // Quads beside a finer neighbour have a corner in the middle of a child's side, which adds the same distance again.
    const double own = centre_deviation(net, corners, levels_[depth]);
    return own > rule_.tolerance || own + 2.0 * inner_bound(corners, curves, kLookAhead, depth) > rule_.tolerance;
  }
  const double own = deviation(corners, levels_[depth], curves);
  return own > rule_.tolerance || own + inner_bound(corners, curves, kLookAhead, depth) > rule_.tolerance;
}

void CellWalk::visit(const CellNet& net, const CornerPoints& corners, CurveSides curves, Buffer<std::uint8_t>& flags) {
  if (leaves_ > rule_.max_leaves) return;
  const bool wanted = beyond(net, corners, curves);
  const bool cut = wanted && net.level < rule_.max_level;
  flags.push_back(cut ? kCut : wanted ? kUnmet : kMet);
  if (!cut) {
    ++leaves_;
    return;
  }
  Expansion& expansion = levels_[static_cast<std::size_t>(net.level)];
  const bool patch = net.kind == CellNet::Kind::Patch;
  if (patch) nets_.children(net, expansion.children);
  for (int k = 0; k < 4; ++k) {
    // The bound of a patch does not use the corners.
    visit(expansion.children[k], patch ? corners : child_corners(corners, expansion, k), child_curves(curves, k),
          flags);
  }
}

CornerPoints corners_of(const CellForest& forest, const Points& points, Index face) {
  CornerPoints corners;
  for (int k = 0; k < forest.corner_count(); ++k) corners[k] = points.row(forest.corner(face, k)).transpose();
  return corners;
}

constexpr std::ptrdiff_t kFacesPerBlock = 16;

/// Splits a cell according to its flags, advances past those it read, and notes the leaves beyond the tolerance.
void cut(CellForest& forest, Index cell, const std::uint8_t*& flag, Buffer<Index>& unmet) {
  const std::uint8_t own = *flag++;
  if (own == kUnmet) unmet.push_back(cell);
  if (own != kCut) return;
  forest.split(cell);
  for (int k = 0; k < 4; ++k) cut(forest, forest.child(cell, k), flag, unmet);
}

}  // namespace

Buffer<Index> cut_by_chord(const CellNets& nets, const LimitSurface& surface, const Points& points,
                           const ChordRule& rule, CellForest& forest, const Progress& progress) {
  const Index faces = forest.base().face_count();
  std::vector<Buffer<std::uint8_t>> blocks(static_cast<std::size_t>(block_count(faces, kFacesPerBlock)));
  std::atomic<std::int64_t> leaves{0};
  parallel_for(
      faces,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Buffer<std::uint8_t>& flags = blocks[static_cast<std::size_t>(begin / kFacesPerBlock)];
        CellWalk walk(nets, surface, forest, rule);
        for (auto f = static_cast<Index>(begin); f < end && leaves <= rule.max_leaves; ++f) {
          if (forest.is_left_out(f)) continue;
          const std::int64_t before = walk.leaves();
          walk.walk(f, corners_of(forest, points, f), flags);
          leaves += walk.leaves() - before;
        }
      },
      kFacesPerBlock, progress);
  if (leaves > rule.max_leaves) {
    throw Error(ErrorCode::TooLarge, "the chord tolerance would make more faces than the " +
                                         std::to_string(rule.max_leaves) +
                                         " cells allowed; take a larger tolerance, fewer levels or allow more faces");
  }
  Buffer<Index> unmet;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::uint8_t* flag = blocks[b].data();
    const auto first = static_cast<Index>(b * kFacesPerBlock);
    for (Index f = first; f < std::min<Index>(first + kFacesPerBlock, faces); ++f) {
      if (!forest.is_left_out(f)) cut(forest, f, flag, unmet);
    }
  }
  return unmet;
}

bool roots_suffice(const CellNets& nets, const LimitSurface& surface, const Points& points, double tolerance,
                   const CellForest& forest) {
  const ChordRule rule{tolerance, false, 0, forest.base().face_count()};
  CellWalk walk(nets, surface, forest, rule);
  for (Index f = 0; f < forest.base().face_count(); ++f) {
    if (!forest.is_left_out(f) && walk.exceeds(f, corners_of(forest, points, f))) return false;
  }
  return true;
}

}  // namespace batten
