#include "batten/adaptive/cell_nets.h"

#include <cmath>

#include "batten/adaptive/cell_forest.h"
#include "batten/patch/corner_parameters.h"
#include "batten/patch/ring_types.h"
#include "batten/scheme/masks.h"

namespace batten {

namespace {

/// A linear combination of a triangle patch's control points.
struct LatticeSum {
  int count = 0;
  std::array<int, 7> points;
  std::array<double, 7> weights;
  void add(int point, double weight) {
    points[count] = point;
    weights[count++] = weight;
  }
};

int lattice_index(int a, int b) {
  for (int i = 0; i < kTrianglePatchSize; ++i) {
    if (kTriangleLattice[i][0] == a && kTriangleLattice[i][1] == b) return i;
  }
  return -1;
}

constexpr int kSteps[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

/// The refined point (a, b) of a lattice with half the spacing.
LatticeSum refined_point(int a, int b) {
  const Scheme loop{SchemeKind::Loop};
  LatticeSum sum;
  if (a % 2 == 0 && b % 2 == 0) {
    const SmoothMask mask = vertex_mask(SchemeKind::Loop, 6);
    sum.add(lattice_index(a / 2, b / 2), mask.vertex);
    for (const auto& step : kSteps) sum.add(lattice_index(a / 2 + step[0], b / 2 + step[1]), mask.edge);
    return sum;
  }
  const EdgeMask mask = edge_mask(loop, 2);
  for (int k = 0; k < 6; ++k) {
    const auto& step = kSteps[k];
    if ((a - step[0]) % 2 != 0 || (b - step[1]) % 2 != 0) continue;
    // Both directions of the edge are handled here, each with its end and the vertex to its left.
    const int x = (a - step[0]) / 2;
    const int y = (b - step[1]) / 2;
    const auto& left = kSteps[(k + 1) % 6];
    sum.add(lattice_index(x, y), mask.end);
    sum.add(lattice_index(x + left[0], y + left[1]), mask.face);
  }
  return sum;
}

/// The twelve control points of each child.
std::array<std::array<LatticeSum, kTrianglePatchSize>, 4> make_triangle_children() {
  std::array<std::array<LatticeSum, kTrianglePatchSize>, 4> children;
  constexpr int kOrigins[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (int c = 0; c < 4; ++c) {
    const int sign = c == 3 ? -1 : 1;
    for (int i = 0; i < kTrianglePatchSize; ++i) {
      children[c][i] =
          refined_point(kOrigins[c][0] + sign * kTriangleLattice[i][0], kOrigins[c][1] + sign * kTriangleLattice[i][1]);
    }
  }
  return children;
}

void halve_triangle(const double* from, std::array<CellNet, 4>& children) {
  static const auto sums = make_triangle_children();
  for (int c = 0; c < 4; ++c) {
    double* to = children[c].points.data();
    for (const LatticeSum& sum : sums[c]) {
      for (int x = 0; x < 3; ++x) {
        double total = 0.0;
        for (int i = 0; i < sum.count; ++i) total += sum.weights[i] * from[3 * sum.points[i] + x];
        *to++ = total;
      }
    }
  }
}

/// Turns four cubic control points, `stride` numbers apart, into five of half the spacing.
void halve_cubic(const double* from, std::ptrdiff_t stride, double* to, std::ptrdiff_t to_stride) {
  for (int x = 0; x < 3; ++x) {
    const double a = from[x];
    const double b = from[stride + x];
    const double c = from[2 * stride + x];
    const double d = from[3 * stride + x];
    to[x] = 0.5 * (a + b);
    to[to_stride + x] = kCreaseNeighbour * (a + c) + kCreaseVertex * b;
    to[2 * to_stride + x] = 0.5 * (b + c);
    to[3 * to_stride + x] = kCreaseNeighbour * (b + d) + kCreaseVertex * c;
    to[4 * to_stride + x] = 0.5 * (c + d);
  }
}

void halve_quad(const double* from, std::array<CellNet, 4>& children) {
  double rows[4 * 5 * 3];
  double grid[5 * 5 * 3];
  for (int j = 0; j < 4; ++j) halve_cubic(from + 12 * j, 3, rows + 15 * j, 3);
  for (int i = 0; i < 5; ++i) halve_cubic(rows + 3 * i, 15, grid + 3 * i, 15);
  for (int c = 0; c < 4; ++c) {
    const int x = c == 1 || c == 2 ? 1 : 0;
    const int y = c >= 2 ? 1 : 0;
    double* to = children[c].points.data();
    for (int j = 0; j < 4; ++j) {
      const double* row = grid + 15 * (j + y) + 3 * x;
      for (int i = 0; i < 12; ++i) *to++ = row[i];
    }
  }
}

}  // namespace

CellNets::CellNets(const SurfacePatches& patches, ConstValuesRef control)
    : patches_(patches), base_values_(patches.base_values(control)), values_(patches.pieces(), base_values_) {}

void CellNets::root(Index face, CellNet& net) const {
  net.face = face;
  net.level = 0;
  net.turned = false;
  net.u = net.v = 0.0;
  find(net);
}

/// Finds the control points of a cell of up to kRingPieceLevels levels, if it is one piece.
void CellNets::find(CellNet& net) const {
  net.kind = CellNet::Kind::Several;
  constexpr double kSide = 1 << kRingPieceLevels;
  const Pieces& pieces = patches_.pieces();
  const Piece* piece = pieces.begin(net.face);
  const auto x = static_cast<Index>(std::lround(net.u * kSide));
  const auto y = static_cast<Index>(std::lround(net.v * kSide));
  while (piece != pieces.end(net.face) && (piece->x != x || piece->y != y || piece->turned != net.turned ||
                                           piece->size != (1 << (kRingPieceLevels - net.level)))) {
    ++piece;
  }
  if (piece == pieces.end(net.face)) return;
  const bool patch = piece->kind == Piece::Kind::Patch;
  net.kind = patch ? CellNet::Kind::Patch : CellNet::Kind::Ring;
  net.ring = patch ? RingTypes::kPatch : patches_.ring_type(*piece);
  FaceRing scratch;
  const std::span<const Index> rows =
      patch ? std::span(pieces.rows(*piece), static_cast<std::size_t>(patches_.patch_size()))
            : pieces.ring(*piece, scratch);
  ConstValuesRef values = values_.at(piece->level);
  net.points.resize(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] != RegularPatch::kMissing) net.points.row(static_cast<Eigen::Index>(i)) = values.row(rows[i]);
  }
  if (patch) complete_patch(quads(), rows.data(), net.points.data(), 3);
}

void CellNets::children(const CellNet& net, std::array<CellNet, 4>& children) const {
  const double half = std::ldexp(net.turned ? -0.5 : 0.5, -net.level);
  const int corners = quads() ? 4 : 3;
  for (int k = 0; k < 4; ++k) {
    CellNet& child = children[k];
    const std::array<double, 2> at = k == corners ? std::array<double, 2>{1.0, 1.0} : corner_parameters(corners, k);
    child.face = net.face;
    child.level = net.level + 1;
    child.turned = net.turned != (k == corners);
    child.u = net.u + half * at[0];
    child.v = net.v + half * at[1];
    if (net.kind == CellNet::Kind::Several) find(child);
  }
  if (net.kind == CellNet::Kind::Patch) halve_patch(net, children);
  if (net.kind == CellNet::Kind::Ring) halve_ring(net, children);
}

void CellNets::halve_patch(const CellNet& net, std::array<CellNet, 4>& children) const {
  for (CellNet& child : children) {
    child.kind = CellNet::Kind::Patch;
    child.points.resize(net.points.rows(), 3);
  }
  if (quads()) {
    halve_quad(net.points.data(), children);
  } else {
    halve_triangle(net.points.data(), children);
  }
}

void CellNets::halve_ring(const CellNet& net, std::array<CellNet, 4>& children) const {
  for (int k = 0; k < 4; ++k) {
    const RingTypes::Child& step = patches_.ring_types().child(net.ring, k);
    CellNet& child = children[k];
    child.ring = step.type;
    child.kind = step.type == RingTypes::kPatch ? CellNet::Kind::Patch : CellNet::Kind::Ring;
    child.points.resize(step.rows.count(), 3);
    for (Index r = 0; r < step.rows.count(); ++r) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (Index e = step.rows.starts[r]; e < step.rows.starts[r + 1]; ++e) {
        sum += step.rows.weights[e] * net.points.row(step.rows.columns[e]);
      }
      child.points.row(r) = sum;
    }
    if (step.type != RingTypes::kPatch) continue;
    complete_patch(quads(), step.patch.rows.data(), child.points.data(), 3);
  }
}

Eigen::Vector3d CellNets::patch_corner(const CellNet& net, int corner) const {
  const std::array<double, 2> at = corner_parameters(quads() ? 4 : 3, corner);
  const int a = static_cast<int>(at[0]);
  const int b = static_cast<int>(at[1]);
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  if (quads()) {
    constexpr double kWeights[3] = {kCreaseLimitNeighbour, kCreaseLimitVertex, kCreaseLimitNeighbour};
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) sum += kWeights[i] * kWeights[j] * net.points.row(4 * (b + j) + a + i);
    }
    return sum.transpose();
  }
  const SmoothMask mask = limit_mask(SchemeKind::Loop, 6);
  sum = mask.vertex * net.points.row(lattice_index(a, b));
  for (const auto& step : kSteps) sum += mask.edge * net.points.row(lattice_index(a + step[0], b + step[1]));
  return sum.transpose();
}

}  // namespace batten
