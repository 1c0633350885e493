#include "batten/interpolate/fair_normals.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <cstdint>
#include <utility>

#include "batten/limit/vertex_limit.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/sparse_rows.h"

namespace batten {

namespace {

/// Tangents with less than this share of the larger one across it are parallel whatever the unknowns.
constexpr double kNoTangent = 1e-9;
constexpr std::ptrdiff_t kConditionBlock = 512;

/// Creases have a normal on each side, corners a cone of them.
bool has_one_normal(const LimitMatrix& limit, Index vertex, VertexRing& ring) {
  if (limit.row_kind(vertex) == LimitRow::Fixed) return false;
  const RingRules rules = ring_rules(limit.topology(), limit.scheme(), 0.0, vertex, ring);
  return limit_sectors(rules, LimitMasks::Exact).size() == 1;
}

/// The least rotation that turns one direction onto another; of opposite ones, one of the half turns.
Eigen::Matrix3d turn_onto(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double cosine = from.dot(to);
  const bool opposite = !(sine > 1e-12 * std::abs(cosine));
  return Eigen::AngleAxisd(std::atan2(sine, cosine),
                           opposite ? from.unitOrthogonal().eval() : Eigen::Vector3d(axis / sine))
      .toRotationMatrix();
}

}  // namespace

/// All but the normal. False where there is no tangent plane.
bool FairNormals::find_condition(const LimitMatrix& limit, Index vertex,
                                 const Eigen::SparseMatrix<double, Eigen::RowMajor>& to_control, const Values& constant,
                                 Condition& condition) {
  const Topology& refined = limit.topology();
  VertexWeights entries;  // of both tangents: the column's number twice, plus the tangent's
  condition.constant.setZero();
  for (int t = 0; t < 2; ++t) {
    const TileValue tangent = t == 0 ? TileValue::TangentU : TileValue::TangentV;
    visit_vertex_limit(
        refined, limit.scheme(), tangent, refined.vertex_half_edge(vertex), [&](Index of, double weight) {
          condition.constant.row(t) += weight * constant.row(of);
          for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(to_control, of); entry; ++entry) {
            entries.emplace_back(2 * static_cast<Index>(entry.col()) + t, weight * entry.value());
          }
        });
  }
  merge(entries);
  for (const auto& [place, weight] : entries) {
    if (condition.columns.empty() || condition.columns.back() != place / 2) condition.columns.push_back(place / 2);
  }
  Rows rows = Rows::Zero(2, static_cast<Eigen::Index>(condition.columns.size()));
  Eigen::Index column = 0;
  for (const auto& [place, weight] : entries) {
    while (condition.columns[column] != place / 2) ++column;
    rows(place % 2, column) = weight;
  }
  // Rows become orthonormal: R^T Q^T unknowns = tangents - constant is Q^T unknowns = R^-T (tangents - constant).
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 2>> qr(rows.transpose());
  const Eigen::Matrix2d r = qr.matrixR().topRows<2>().triangularView<Eigen::Upper>();
  if (!(std::abs(r(1, 1)) > kNoTangent * std::abs(r(0, 0)))) return false;
  const Eigen::Matrix<double, Eigen::Dynamic, 2> q =
      qr.householderQ() * Eigen::Matrix<double, Eigen::Dynamic, 2>::Identity(rows.cols(), 2);
  condition.rows = q.transpose();
  condition.to_rows = (r * qr.colsPermutation().transpose()).transpose().inverse();
  condition.values = -condition.to_rows * condition.constant;
  return true;
}

FairNormals::FairNormals(const LimitMatrix& limit, ConstValuesRef normals,
                         const Eigen::SparseMatrix<double, Eigen::RowMajor>& to_control, const Values& constant) {
  const auto count = static_cast<std::size_t>(normals.rows());
  std::vector<Condition> found(count);
  Buffer<std::uint8_t> holds(count, 0);
  parallel_for(
      normals.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        VertexRing ring;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const auto v = static_cast<Index>(i);
          Condition& condition = found[static_cast<std::size_t>(i)];
          if (normals.row(v).isZero(0.0) || !has_one_normal(limit, v, ring)) continue;
          if (!find_condition(limit, v, to_control, constant, condition)) continue;
          condition.normal = normals.row(v).normalized();
          condition.directions = condition.normal.transpose() * condition.normal;
          holds[i] = 1;
        }
      },
      kConditionBlock);
  for (std::size_t i = 0; i < count; ++i) {
    if (holds[i] == 0) continue;
    conditions_.push_back(std::move(found[i]));
    vertices_.push_back(static_cast<Index>(i));
  }
}

FairNormals::Tangents FairNormals::product(const Condition& condition, const Values& unknowns) {
  Tangents sum = Tangents::Zero();
  for (std::size_t j = 0; j < condition.columns.size(); ++j) {
    sum += condition.rows.col(static_cast<Eigen::Index>(j)) * unknowns.row(condition.columns[j]).head<3>();
  }
  return sum;
}

FairNormals::Tangents FairNormals::tangents(const Condition& condition, const Values& unknowns) {
  return condition.to_rows.inverse() * product(condition, unknowns) + condition.constant;
}

Index FairNormals::hold_opposed(const Values& unknowns, const Values& model) {
  Index count = 0;
  for (Condition& condition : conditions_) {
    const Tangents opposed = tangents(condition, unknowns);
    if (opposed.row(0).cross(opposed.row(1)).dot(condition.normal) >= 0.0) continue;
    const Tangents wanted = tangents(condition, model);
    const Eigen::Vector3d normal = wanted.row(0).cross(wanted.row(1)).transpose();
    const Tangents turned = (turn_onto(normal, condition.normal.transpose()) * wanted.transpose()).transpose();
    condition.values = condition.to_rows * (turned - condition.constant);
    condition.directions.setIdentity();
    ++count;
  }
  return count;
}

void FairNormals::move(Values& unknowns, double values_factor) const {
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Condition& condition = conditions_[static_cast<std::size_t>(i)];
          const Tangents missing =
              (values_factor * condition.values - product(condition, unknowns)) * condition.directions;
          for (std::size_t j = 0; j < condition.columns.size(); ++j) {
            unknowns.row(condition.columns[j]) +=
                condition.rows.col(static_cast<Eigen::Index>(j)).transpose() * missing;
          }
        }
      },
      kConditionBlock);
}

Values FairNormals::rows(const Values& unknowns) const {
  Values result(2 * static_cast<Eigen::Index>(count()), 3);
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Condition& condition = conditions_[static_cast<std::size_t>(i)];
          result.middleRows<2>(2 * i) = product(condition, unknowns) * condition.directions;
        }
      },
      kConditionBlock);
  return result;
}

void FairNormals::add_transposed(const Values& multipliers, Values& result) const {
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Condition& condition = conditions_[static_cast<std::size_t>(i)];
          const Tangents pull = multipliers.middleRows<2>(2 * i) * condition.directions;
          for (std::size_t j = 0; j < condition.columns.size(); ++j) {
            result.row(condition.columns[j]) += condition.rows.col(static_cast<Eigen::Index>(j)).transpose() * pull;
          }
        }
      },
      kConditionBlock);
}

std::vector<Eigen::Matrix2d> FairNormals::stiffness(const Eigen::SparseMatrix<double, Eigen::RowMajor>& h) const {
  std::vector<Eigen::Matrix2d> result(conditions_.size());
  parallel_for(
      count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Eigen::MatrixXd block;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Condition& condition = conditions_[static_cast<std::size_t>(i)];
          const auto size = static_cast<Eigen::Index>(condition.columns.size());
          block.resize(size, size);
          for (Eigen::Index r = 0; r < size; ++r) {
            for (Eigen::Index c = 0; c < size; ++c)
              block(r, c) = h.coeff(condition.columns[static_cast<std::size_t>(r)],
                                    condition.columns[static_cast<std::size_t>(c)]);
          }
          const Eigen::Matrix2d give = condition.rows * block.ldlt().solve(condition.rows.transpose());
          result[static_cast<std::size_t>(i)] = give.inverse();
        }
      },
      kConditionBlock);
  return result;
}

void FairNormals::meet(Values& unknowns) const { move(unknowns, 1.0); }
void FairNormals::project(Values& step) const { move(step, 0.0); }

}  // namespace batten
