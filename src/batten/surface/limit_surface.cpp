#include "batten/surface/limit_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/limit/vertex_limit.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/halving.h"
#include "batten/patch/level_values.h"
#include "batten/patch/spline_jet.h"
#include "batten/surface/ring_blocks.h"
#include "batten/surface/ring_descents.h"

namespace batten {

namespace {

/// So many halvings of irregular faces are kept at most, and so many points (of 32 bytes) for each vertex of the base:
/// all kept halvings where few faces are irregular, one or two where all are.
constexpr int kMostKeptHalvings = 8;
constexpr std::size_t kKeptPointsPerVertex = 96;

/// The corner that a place is nearest to, and how many halvings in a row lead to the child there.
struct Approach {
  int corner;
  int halvings;
};
Approach approach(bool quads, double u, double v) {
  int corner = 0;
  double distance = u + v;
  if (quads) {
    static constexpr int kCorners[4] = {0, 1, 3, 2};
    const bool right = u >= 0.5;
    const bool up = v >= 0.5;
    corner = kCorners[(right ? 1 : 0) + (up ? 2 : 0)];
    distance = std::max(right ? 1.0 - u : u, up ? 1.0 - v : v);
  } else if (u >= 0.5) {
    corner = 1;
    distance = 1.0 - u;
  } else if (v >= 0.5) {
    corner = 2;
    distance = 1.0 - v;
  }
  // 2^-halvings is the next power of two from the distance on: the exponent of a double, from 2^-1 on.
  std::uint64_t bits = 0;
  std::memcpy(&bits, &distance, sizeof(bits));
  return {corner, std::max(0, 1022 - static_cast<int>(bits >> 52))};
}

/// (u, v) become those of the child that so many halvings towards a corner lead to. Returns how much faster they run.
double approach_corner(bool quads, int corner, int halvings, double& u, double& v) {
  const double factor = std::ldexp(1.0, halvings);
  const auto approached = [&](double parameter, bool far_side) {
    return far_side ? 1.0 - factor * (1.0 - parameter) : factor * parameter;
  };
  u = approached(u, corner == 1 || (quads && corner == 2));
  v = approached(v, corner >= 2);
  return factor;
}

constexpr auto kOpenPatch = static_cast<std::size_t>(-1);

/// The jet of a patch, whose parameters run `scale` times as fast as the place's.
void set_jet(const PatchJet& patch, const Double4& origin, double scale, Jet& jet) {
  const double second = scale * scale;
  const auto set = [](const Double4& from, Eigen::Vector3d& to) { to << from[0], from[1], from[2]; };
  set(patch[0] + origin, jet.point);
  set(patch[1] * scale, jet.du);
  set(patch[2] * scale, jet.dv);
  set(patch[3] * second, jet.duu);
  set(patch[4] * second, jet.duv);
  set(patch[5] * second, jet.dvv);
  jet.regular = true;
}

}  // namespace

struct LimitSurface::Parts {
  SurfacePatches patches;
  bool quads;
  const Pieces& pieces;
  const RingTypes& types;
  Buffer<Index> ring_types;  ///< of each shared ring
  RingBlocks blocks;
  RingDescents descents;
  int kept_halvings = 0;
  /// Of each piece: where its tree stands in `trees`, or whether points of its patch are missing.
  Buffer<std::size_t> tree_starts;
  std::vector<Buffer<Double4>> points;  ///< of each level of the pieces
  Buffer<Double4> trees;

  explicit Parts(const SurfacePatches& patches_in)
      : patches(patches_in),
        quads(patches.quads()),
        pieces(patches.pieces()),
        types(patches.ring_types()),
        blocks(types, kMostKeptHalvings),
        descents(types) {
    for (std::size_t i = 0; i < pieces.shared_rings().size(); ++i) {
      ring_types.push_back(patches.ring_type(static_cast<std::int32_t>(i)));
    }
    lay_out_trees();
  }

  const Topology& base() const { return patches.base(); }
  std::size_t patch_size() const { return static_cast<std::size_t>(patches.patch_size()); }

  /// Rings at poles have none: they are large, and halve from a narrow part of the ring.
  bool has_tree(const Piece& piece) const {
    return piece.kind != Piece::Kind::Patch && !types.at_pole(ring_types[piece.shared_ring]);
  }
  void lay_out_trees();
  void set_control(ConstValuesRef control, const Progress& progress);
  void check(const SurfacePlace& place) const { require_place(base(), place); }
  const Piece& locate(const SurfacePlace& place, double& u, double& v) const;
  void set(const SurfacePlace& place, DescentScratch& scratch, Jet& jet) const;
  void set_on_open_patch(const Piece& piece, double u, double v, double scale, Jet& jet) const;
  void set_on_ring(const Piece& piece, double u, double v, double scale, DescentScratch& scratch, Jet& jet) const;
  void set_at_vertex(const Piece& piece, double u, double v, Jet& jet) const;
  std::size_t number_of(const Piece& piece) const { return static_cast<std::size_t>(&piece - pieces.begin(0)); }
};

/// The deepest trees that have their place.
void LimitSurface::Parts::lay_out_trees() {
  const Piece* begin = pieces.begin(0);
  const Piece* end = base().face_count() == 0 ? begin : pieces.end(base().face_count() - 1);
  const auto most = kKeptPointsPerVertex * static_cast<std::size_t>(base().vertex_count());
  Buffer<std::size_t> pieces_of_type(static_cast<std::size_t>(types.type_count()), 0);
  for (const Piece* piece = begin; piece != end; ++piece) {
    if (has_tree(*piece)) ++pieces_of_type[ring_types[piece->shared_ring]];
  }
  for (int depth = 1; depth <= kMostKeptHalvings; ++depth) {
    std::size_t total = 0;
    for (Index type = 0; type < types.type_count(); ++type) {
      total += pieces_of_type[type] * blocks.node(blocks.node_of(type, depth)).size;
    }
    if (total > most) break;
    kept_halvings = depth;
  }
  tree_starts.assign(static_cast<std::size_t>(end - begin), 0);
  std::size_t size = 0;
  for (const Piece* piece = begin; piece != end; ++piece) {
    tree_starts[piece - begin] = size;
    if (piece->kind == Piece::Kind::Patch) {
      const Index* rows = pieces.rows(*piece);
      if (std::find(rows, rows + patch_size(), RegularPatch::kMissing) != rows + patch_size()) {
        tree_starts[piece - begin] = kOpenPatch;
      }
    } else if (has_tree(*piece) && kept_halvings > 0) {
      size += blocks.node(blocks.node_of(ring_types[piece->shared_ring], kept_halvings)).size;
    }
  }
  trees.resize(size);
}

void LimitSurface::Parts::set_control(ConstValuesRef control, const Progress& progress) {
  constexpr double kPoints = 0.5;  // of the time
  require_control_points(patches.topology(), control);
  const Values base_control = patches.base_values(control, progress_within(progress, 0.0, kPoints));
  std::vector<Buffer<Double4>> level = level_points(patches, base_control);
  Buffer<Double4> filled(trees.size());
  if (kept_halvings > 0) {
    parallel_for(
        base().face_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Buffer<Double4> scratch;
          FaceRing ring;
          for (auto f = static_cast<Index>(begin); f < end; ++f) {
            for (const Piece* piece = pieces.begin(f); piece != pieces.end(f); ++piece) {
              if (!has_tree(*piece)) continue;
              blocks.fill(blocks.node_of(ring_types[piece->shared_ring], kept_halvings), level[piece->level].data(),
                          pieces.ring(*piece, ring).data(), Double4{}, &filled[tree_starts[number_of(*piece)]],
                          scratch);
            }
          }
        },
        256, progress_within(progress, kPoints, 1.0));
  }
  points = std::move(level);
  trees = std::move(filled);
}

/// The piece that a place lies in; (u, v) become its own parameters.
const Piece& LimitSurface::Parts::locate(const SurfacePlace& place, double& u, double& v) const {
  const Piece* piece = pieces.begin(place.face);
  u = place.u;
  v = place.v;
  if (piece->level == 0) return *piece;
  const double steps_per_side = 1 << kRingPieceLevels;
  const double x = place.u * steps_per_side;
  const double y = place.v * steps_per_side;
  // Rounding on a line between triangles may leave a place outside all of them: the nearest one will do.
  const Piece* nearest = piece;
  double least_outside = std::numeric_limits<double>::infinity();
  for (; piece != pieces.end(place.face); ++piece) {
    const double along = (piece->turned ? piece->x - x : x - piece->x) / piece->size;
    const double across = (piece->turned ? piece->y - y : y - piece->y) / piece->size;
    const double beyond = quads ? std::max(along, across) - 1.0 : along + across - 1.0;
    const double outside = std::max({-along, -across, beyond, 0.0});
    if (outside >= least_outside) continue;
    least_outside = outside;
    nearest = piece;
    u = along;
    v = across;
    if (outside == 0.0) break;
  }
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, quads ? 1.0 : 1.0 - u);
  return *nearest;
}

/// Of a patch at a boundary or crease, whose other side follows by reflection.
void LimitSurface::Parts::set_on_open_patch(const Piece& piece, double u, double v, double scale, Jet& jet) const {
  const Double4* from = points[piece.level].data();
  const Index* rows = pieces.rows(piece);
  std::array<Double4, 16> patch{};
  std::array<Index, 16> order{};
  for (std::size_t i = 0; i < patch_size(); ++i) {
    order[i] = static_cast<Index>(i);
    if (rows[i] != RegularPatch::kMissing) patch[i] = from[rows[i]];
  }
  complete_patch(quads, rows, reinterpret_cast<double*>(patch.data()), 4);
  PatchJet patch_sums;
  patch_jet(quads, u, v, patch.data(), order.data(), patch_sums);
  set_jet(patch_sums, Double4{}, scale, jet);
}

/// Halves the face until it is regular: down its tree, then as deep as it takes.
void LimitSurface::Parts::set_on_ring(const Piece& piece, double u, double v, double scale, DescentScratch& scratch,
                                      Jet& jet) const {
  const double first_u = u;
  const double first_v = v;
  Descent at{ring_types[piece.shared_ring], points[piece.level].data(), pieces.ring(piece, scratch.gathered).data(),
             Double4{}};
  int halvings = 0;
  if (types.at_pole(at.type)) {
    at.type = types.narrowed(at.type, approach(quads, u, v).halvings + 1);
  } else if (kept_halvings > 0) {
    const Double4* tree = trees.data() + tree_starts[number_of(piece)];
    std::int32_t node = blocks.node_of(at.type, kept_halvings);
    const Approach near = approach(quads, u, v);
    const std::span<const RingBlocks::Jump> jumps = blocks.jumps(node, near.corner);
    halvings = std::min(near.halvings, static_cast<int>(jumps.size()));
    if (halvings > 0) {
      const RingBlocks::Jump& jump = jumps[halvings - 1];
      scale *= approach_corner(quads, near.corner, halvings, u, v);
      at = {jump.child.type, tree + jump.block + 1, jump.child.points, tree[jump.block]};
      tree += jump.tree;
      node = jump.child.node;
    }
    while (node >= 0) {
      const Halving step = halve(quads, u, v);
      ++halvings;
      scale *= step.factor;
      const RingBlocks::Node::Child& child = blocks.node(node).children[step.child];
      at = {child.type, tree + 1, child.points, tree[0]};
      tree += child.offset;
      node = child.node;
    }
  }
  while (at.type != RingTypes::kPatch && halvings < kHalvingsToVertex) {
    const Approach near = approach(quads, u, v);
    const int to_corner = std::min(near.halvings, descents.most_to_corner(at.type, near.corner));
    scale *= approach_corner(quads, near.corner, to_corner, u, v);
    const Halving step = halve(quads, u, v);
    scale *= step.factor;
    halvings += to_corner + 1;
    descents.descend(near.corner, to_corner, step.child, scratch, at);
  }
  if (at.type != RingTypes::kPatch) return set_at_vertex(piece, first_u, first_v, jet);
  PatchJet sums;
  patch_jet(quads, u, v, at.points, at.rows, sums);
  set_jet(sums, at.origin, scale, jet);
}

/// At the corner of the piece that the place is.
void LimitSurface::Parts::set_at_vertex(const Piece& piece, double u, double v, Jet& jet) const {
  const Topology& topology = pieces.topology(piece.level);
  Index half_edge = piece.half_edge;
  const Index corner = nearest_corner(quads, u, v);
  for (Index c = 0; c < corner; ++c) half_edge = topology.next(half_edge);
  const auto sum = [&](TileValue value) {
    Double4 total{};
    visit_vertex_limit(topology, pieces.scheme(), value, half_edge,
                       [&](Index vertex, double weight) { total += weight * points[piece.level][vertex]; });
    return Eigen::Vector3d(total[0], total[1], total[2]);
  };
  jet.point = sum(TileValue::Limit);
  jet.du = sum(TileValue::TangentU);
  jet.dv = sum(TileValue::TangentV);
  jet.duu = jet.duv = jet.dvv = Eigen::Vector3d::Zero();
  jet.regular = false;
}

void LimitSurface::Parts::set(const SurfacePlace& place, DescentScratch& scratch, Jet& jet) const {
  double u = 0.0;
  double v = 0.0;
  const Piece& piece = locate(place, u, v);
  const double size = static_cast<double>(1 << kRingPieceLevels) / piece.size;
  const double scale = piece.turned ? -size : size;
  if (piece.kind != Piece::Kind::Patch) return set_on_ring(piece, u, v, scale, scratch, jet);
  if (tree_starts[number_of(piece)] == kOpenPatch) return set_on_open_patch(piece, u, v, scale, jet);
  PatchJet sums;
  patch_jet(quads, u, v, points[piece.level].data(), pieces.rows(piece), sums);
  set_jet(sums, Double4{}, scale, jet);
}

void require_place(const Topology& base, const SurfacePlace& place) {
  const bool quads = base.uniform_face_size() != 3;
  const double most = quads ? 1.0 : 1.0 - place.v;
  const bool inside = place.u >= 0.0 && place.v >= 0.0 && place.u <= most && place.v <= 1.0;
  if (inside && place.face >= 0 && place.face < base.face_count()) return;
  if (place.face < 0 || place.face >= base.face_count()) {
    throw Error(ErrorCode::IndexOutOfRange, "face " + std::to_string(place.face) + " does not exist; the base has " +
                                                std::to_string(base.face_count()) + " faces");
  }
  throw Error(ErrorCode::BadArgument,
              "(u, v) = (" + std::to_string(place.u) + ", " + std::to_string(place.v) + ") is not in the face");
}

LimitSurface::LimitSurface(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress)
    : parts_(std::make_unique<Parts>(patches)) {
  parts_->set_control(control, progress);
}

LimitSurface::LimitSurface(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                           const Progress& progress)
    : LimitSurface(SurfacePatches(topology, scheme, progress_within(progress, 0.0, 0.3)), control,
                   progress_within(progress, 0.3, 1.0)) {}

LimitSurface::~LimitSurface() = default;
LimitSurface::LimitSurface(LimitSurface&&) noexcept = default;

const SurfacePatches& LimitSurface::patches() const { return parts_->patches; }
void LimitSurface::set_control(ConstValuesRef control, const Progress& progress) {
  parts_->set_control(control, progress);
}

Jet LimitSurface::jet(const SurfacePlace& place) const {
  parts_->check(place);
  DescentScratch scratch;
  Jet result;
  parts_->set(place, scratch, result);
  return result;
}

void LimitSurface::jets(std::span<const SurfacePlace> places, std::span<Jet> jets) const {
  if (places.size() != jets.size()) {
    throw Error(ErrorCode::BadShape,
                std::to_string(places.size()) + " places ask for as many jets, not " + std::to_string(jets.size()));
  }
  for (const SurfacePlace& place : places) parts_->check(place);
  parallel_for(
      static_cast<std::ptrdiff_t>(places.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        DescentScratch scratch;
        for (std::ptrdiff_t i = begin; i < end; ++i) parts_->set(places[i], scratch, jets[i]);
      },
      256);
}

}  // namespace batten
