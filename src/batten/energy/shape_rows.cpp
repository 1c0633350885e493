#include "batten/energy/shape_rows.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace batten {

namespace {

/// Sine of the angle between x_u and x_v below which there is no tangent plane.
constexpr double kFlatAngle = 1e-3;

/// Where the second derivative by parameters i and j stands among Duu, Duv, Dvv; the third likewise.
constexpr int pair_of(int i, int j) { return i + j; }
constexpr std::array<std::array<int, 3>, 4> kTriples{{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

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
    const Eigen::Vector3d along = jet.row(0);
    const Eigen::Vector3d across = jet.row(1);
    const double length = along.norm();
    const Eigen::Vector3d cross = along.cross(across);
    area_ = cross.norm();
    if (!(area_ > kFlatAngle * length * across.norm())) {
      area_ = 0.0;
      return;
    }
    const Eigen::Vector3d first = along / length;
    const Eigen::Vector3d second = cross.cross(first) / area_;
    // Columns: how u and v grow along two unit vectors of the plane.
    step_ << 1.0 / length, -across.dot(first) / (length * across.dot(second)), 0.0, 1.0 / across.dot(second);
    dual_.col(0) = step_(0, 0) * first + step_(0, 1) * second;
    dual_.col(1) = step_(1, 1) * second;
  }

  double area() const { return area_; }
  void stretch(ShapeRows& rows) const { rows = step_.transpose(); }
  void bending(ShapeRows& rows) const;
  void variation(ShapeRows& rows) const;

 private:
  /// G^l_ij in row pair_of(i, j), column l.
  Eigen::Matrix<double, 3, 2> connection() const { return jet_.middleRows<3>(2) * dual_; }

  const ShapeJet& jet_;
  double area_ = 0.0;
  Eigen::Matrix2d step_;
  Eigen::Matrix<double, 3, 2> dual_;
};

/// From parameters to unit vectors; the mixed derivative counts twice.
void PlaneDerivatives::bending(ShapeRows& rows) const {
  Eigen::Matrix<double, 3, 5> forms;
  forms.leftCols<2>() = -connection();
  forms.rightCols<3>().setIdentity();
  Eigen::Matrix3d turn;
  constexpr std::array<std::array<int, 2>, 3> kPairs{{{0, 0}, {0, 1}, {1, 1}}};
  for (int r = 0; r < 3; ++r) {
    const auto a = step_.col(kPairs[r][0]);
    const auto b = step_.col(kPairs[r][1]);
    turn.row(r) << a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1];
  }
  turn.row(1) *= std::sqrt(2.0);
  rows = turn * forms;
}

/// Likewise; the mixed derivatives count three times. The forms are those of the first, second and third derivatives;
/// the last are the identity.
void PlaneDerivatives::variation(ShapeRows& rows) const {
  const Eigen::Matrix<double, 3, 2> g = connection();
  Eigen::Matrix<double, 4, 2> of_first = -jet_.middleRows<4>(5) * dual_;
  Eigen::Matrix<double, 4, 3> of_second = Eigen::Matrix<double, 4, 3>::Zero();
  for (int t = 0; t < 4; ++t) {
    for (int turn = 0; turn < 3; ++turn) {
      const int pair = pair_of(kTriples[t][turn], kTriples[t][(turn + 1) % 3]);
      const int other = kTriples[t][(turn + 2) % 3];
      for (int l = 0; l < 2; ++l) {
        of_second(t, pair_of(l, other)) -= g(pair, l);
        of_first.row(t) += g(pair, l) * g.row(pair_of(l, other));
      }
    }
  }
  Eigen::Matrix4d turned;
  for (int r = 0; r < 4; ++r) {
    const auto a = step_.col(kTriples[r][0]);
    const auto b = step_.col(kTriples[r][1]);
    const auto c = step_.col(kTriples[r][2]);
    turned.row(r) << a[0] * b[0] * c[0], a[0] * b[0] * c[1] + a[0] * b[1] * c[0] + a[1] * b[0] * c[0],
        a[0] * b[1] * c[1] + a[1] * b[0] * c[1] + a[1] * b[1] * c[0], a[1] * b[1] * c[1];
  }
  turned.middleRows<2>(1) *= std::sqrt(3.0);
  rows.resize(4, 9);
  rows.leftCols<2>().noalias() = turned.lazyProduct(of_first);
  rows.middleCols<3>(2).noalias() = turned.lazyProduct(of_second);
  rows.rightCols<4>() = turned;
}

}  // namespace

std::span<const JetRow> shape_jet_rows(ShapeEnergyKind kind) {
  static constexpr std::array<JetRow, kMostShapeJetRows> kRows{JetRow::Du,   JetRow::Dv,   JetRow::Duu,
                                                               JetRow::Duv,  JetRow::Dvv,  JetRow::Duuu,
                                                               JetRow::Duuv, JetRow::Duvv, JetRow::Dvvv};
  constexpr std::array<std::size_t, 3> kCounts{2, 5, 9};
  return std::span(kRows).first(kCounts[static_cast<std::size_t>(kind)]);
}

double shape_rows(ShapeEnergyKind kind, const ShapeJet& reference, ShapeRows& rows) {
  const PlaneDerivatives plane(reference);
  if (plane.area() == 0.0) return 0.0;
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
