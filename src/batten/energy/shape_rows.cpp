#include "batten/energy/shape_rows.h"

#include <cmath>

namespace batten {

namespace {

/// Sine of the angle between x_u and x_v below which there is no tangent plane.
constexpr double kFlatAngle = 1e-3;

/// Where the second derivative by parameters i and j stands among Duu, Duv, Dvv; the third likewise.
constexpr int pair_of(int i, int j) { return i + j; }
constexpr std::array<std::array<int, 3>, 4> kTriples{{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

Double4 dot(const FourVectors& a, const FourVectors& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Double4 length(const FourVectors& a) { return square_roots(dot(a, a)); }
FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// x a + y b.
FourVectors mixed(Double4 x, const FourVectors& a, Double4 y, const FourVectors& b) {
  return {x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]};
}

/// At one place of the reference. With the dual vectors x^l of the tangent plane (x^l . x_m = 1 where l = m, else 0),
/// X has by coordinates y^l = x^l . (x - x(place)) of that plane the derivatives
///
///     second   X_ij - G^l_ij X_l
///     third    X_ijk - (G^l_ij X_lk + G^l_ik X_lj + G^l_jk X_li)
///              - (A^l_ijk - G^l_km G^m_ij - G^l_jm G^m_ik - G^l_im G^m_jk) X_l
///
/// with G^l_ij = x^l . x_ij and A^l_ijk = x^l . x_ijk, by the chain rule.
class PlaneDerivatives {
 public:
  explicit PlaneDerivatives(const ShapeJet& jet) : jet_(jet) {
    const FourVectors& along = jet[0];
    const FourVectors& across = jet[1];
    const FourVectors normal = cross(along, across);
    const Double4 one = Double4{} + 1.0;
    Double4 size = length(along);
    area_ = length(normal);
    const auto flat = !(area_ > kFlatAngle * size * length(across));
    const Double4 area = flat ? one : area_;
    size = flat ? one : size;
    area_ = flat ? Double4{} : area_;
    const FourVectors first = mixed(1.0 / size, along, Double4{}, along);
    const FourVectors second = mixed(1.0 / area, cross(normal, first), Double4{}, along);
    const Double4 height = flat ? one : dot(across, second);
    // Columns: how u and v grow along two unit vectors of the plane.
    step_ = {{{1.0 / size, -dot(across, first) / (size * height)}, {Double4{}, 1.0 / height}}};
    dual_[0] = mixed(step_[0][0], first, step_[0][1], second);
    dual_[1] = mixed(step_[1][1], second, Double4{}, second);
  }

  Double4 area() const { return area_; }
  void stretch(ShapeRows& rows) const {
    for (int r = 0; r < 2; ++r) rows[r][0] = step_[0][r], rows[r][1] = step_[1][r];
  }
  void bending(ShapeRows& rows) const;
  void variation(ShapeRows& rows) const;

 private:
  /// G^l_ij in row pair_of(i, j), column l; here and below of derivative rows `from` on, instead of x_ij.
  template <int Rows>
  std::array<std::array<Double4, 2>, Rows> along_duals(int from) const {
    std::array<std::array<Double4, 2>, Rows> products;
    for (int r = 0; r < Rows; ++r) products[r] = {dot(jet_[from + r], dual_[0]), dot(jet_[from + r], dual_[1])};
    return products;
  }

  const ShapeJet& jet_;
  Double4 area_;
  std::array<std::array<Double4, 2>, 2> step_;
  std::array<FourVectors, 2> dual_;
};

/// From parameters to unit vectors; the mixed derivative counts twice.
void PlaneDerivatives::bending(ShapeRows& rows) const {
  const auto g = along_duals<3>(2);
  constexpr std::array<std::array<int, 2>, 3> kPairs{{{0, 0}, {0, 1}, {1, 1}}};
  for (int r = 0; r < 3; ++r) {
    const auto by = [&](int parameter, int direction) { return step_[parameter][kPairs[r][direction]]; };
    std::array<Double4, 3> turn{by(0, 0) * by(0, 1), by(0, 0) * by(1, 1) + by(1, 0) * by(0, 1), by(1, 0) * by(1, 1)};
    if (r == 1) {
      for (Double4& part : turn) part *= std::sqrt(2.0);
    }
    for (int l = 0; l < 2; ++l) rows[r][l] = -(turn[0] * g[0][l] + turn[1] * g[1][l] + turn[2] * g[2][l]);
    for (int p = 0; p < 3; ++p) rows[r][2 + p] = turn[p];
  }
}

/// Likewise; the mixed derivatives count three times. The forms are those of the first, second and third derivatives;
/// the last are the identity.
void PlaneDerivatives::variation(ShapeRows& rows) const {
  const auto g = along_duals<3>(2);
  auto of_first = along_duals<4>(5);
  std::array<std::array<Double4, 3>, 4> of_second{};
  for (int t = 0; t < 4; ++t) {
    for (int l = 0; l < 2; ++l) of_first[t][l] = -of_first[t][l];
    for (int turn = 0; turn < 3; ++turn) {
      const int pair = pair_of(kTriples[t][turn], kTriples[t][(turn + 1) % 3]);
      const int other = kTriples[t][(turn + 2) % 3];
      for (int l = 0; l < 2; ++l) {
        of_second[t][pair_of(l, other)] -= g[pair][l];
        for (int m = 0; m < 2; ++m) of_first[t][m] += g[pair][l] * g[pair_of(l, other)][m];
      }
    }
  }
  for (int r = 0; r < 4; ++r) {
    const std::array<Double4, 2> a{step_[0][kTriples[r][0]], step_[1][kTriples[r][0]]};
    const std::array<Double4, 2> b{step_[0][kTriples[r][1]], step_[1][kTriples[r][1]]};
    const std::array<Double4, 2> c{step_[0][kTriples[r][2]], step_[1][kTriples[r][2]]};
    std::array<Double4, 4> turned{a[0] * b[0] * c[0], a[0] * b[0] * c[1] + a[0] * b[1] * c[0] + a[1] * b[0] * c[0],
                                  a[0] * b[1] * c[1] + a[1] * b[0] * c[1] + a[1] * b[1] * c[0], a[1] * b[1] * c[1]};
    if (r == 1 || r == 2) {
      for (Double4& part : turned) part *= std::sqrt(3.0);
    }
    const auto turn = [&](const auto& forms, int column) {
      return (turned[0] * forms[0][column] + turned[1] * forms[1][column]) +
             (turned[2] * forms[2][column] + turned[3] * forms[3][column]);
    };
    for (int l = 0; l < 2; ++l) rows[r][l] = turn(of_first, l);
    for (int p = 0; p < 3; ++p) rows[r][2 + p] = turn(of_second, p);
    for (int t = 0; t < 4; ++t) rows[r][5 + t] = turned[t];
  }
}

}  // namespace

std::span<const JetRow> shape_jet_rows(ShapeEnergyKind kind) {
  static constexpr std::array<JetRow, kMostShapeJetRows> kRows{JetRow::Du,   JetRow::Dv,   JetRow::Duu,
                                                               JetRow::Duv,  JetRow::Dvv,  JetRow::Duuu,
                                                               JetRow::Duuv, JetRow::Duvv, JetRow::Dvvv};
  constexpr std::array<std::size_t, 3> kCounts{2, 5, 9};
  return std::span(kRows).first(kCounts[static_cast<std::size_t>(kind)]);
}

Double4 shape_rows(ShapeEnergyKind kind, const ShapeJet& reference, ShapeRows& rows) {
  const PlaneDerivatives plane(reference);
  switch (kind) {
    case ShapeEnergyKind::Stretch:
      plane.stretch(rows);
      break;
    case ShapeEnergyKind::Bending:
      plane.bending(rows);
      break;
    case ShapeEnergyKind::Variation:
      plane.variation(rows);
      break;
  }
  return plane.area();
}

}  // namespace batten
