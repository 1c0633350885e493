#include "batten/interpolate/local_fit.h"

#include <Eigen/SparseLU>
#include <utility>

#include "batten/error.h"
#include "batten/interpolate/local_relaxation.h"
#include "batten/progress.h"

namespace batten {

namespace {

using LocalMatrix = Eigen::SparseMatrix<double>;

/// The equations of the affected rows over the changes of the unknown control points.
struct LocalEquations {
  LocalMatrix a;      ///< all of them
  LocalMatrix exact;  ///< the first ones, which must hold
  Eigen::MatrixXd b;
};

[[noreturn]] void refuse_rings() {
  throw Error(ErrorCode::SingularSystem,
              "the control points within these rings cannot meet the changed targets; allow more rings");
}

/// Every vertex whose row has one of the places as a column: the places first.
std::vector<Index> affected_places(LocalRows& rows, const std::vector<Index>& places) {
  std::vector<Index> affected = places;
  for (const Index place : places) rows.row(place);  // numbers all that are met
  std::vector<std::uint8_t> is_in(static_cast<std::size_t>(rows.size()), 0);
  for (const Index place : places) is_in[place] = 1;
  for (const Index place : places) {
    for (const LocalRows::Entry& entry : rows.row(place)) {
      if (std::exchange(is_in[entry.place], 1) == 0) affected.push_back(entry.place);
    }
  }
  return affected;
}

LocalEquations make_equations(LocalRows& rows, const std::vector<Index>& places, const std::vector<Index>& affected,
                              std::size_t exact, ConstValuesRef targets, ConstValuesRef control) {
  for (const Index place : affected) rows.row(place);
  std::vector<Index> column(static_cast<std::size_t>(rows.size()), -1);
  for (std::size_t i = 0; i < places.size(); ++i) column[places[i]] = static_cast<Index>(i);
  std::vector<Eigen::Triplet<double>> entries;
  LocalEquations equations;
  const auto row_count = static_cast<Eigen::Index>(affected.size());
  const auto column_count = static_cast<Eigen::Index>(places.size());
  equations.b.resize(row_count, targets.cols());
  ValueRow residual(targets.cols());
  for (Eigen::Index i = 0; i < row_count; ++i) {
    const Index place = affected[static_cast<std::size_t>(i)];
    row_residual(rows.matrix(), rows.vertex(place), targets, control, residual.data());
    equations.b.row(i) = residual;
    for (const LocalRows::Entry& entry : rows.row(place)) {
      if (column[entry.place] < 0 || entry.weight == 0.0) continue;
      entries.emplace_back(static_cast<Index>(i), column[entry.place], entry.weight);
    }
  }
  equations.a.resize(row_count, column_count);
  equations.a.setFromTriplets(entries.begin(), entries.end());
  std::erase_if(entries, [exact](const auto& entry) { return static_cast<std::size_t>(entry.row()) >= exact; });
  equations.exact.resize(static_cast<Eigen::Index>(exact), column_count);
  equations.exact.setFromTriplets(entries.begin(), entries.end());
  return equations;
}

/// [N C^T; C 0] with N = A^T A: the conditions for the least squares under C x = c, multipliers below.
LocalMatrix saddle_matrix(const LocalEquations& equations) {
  const LocalMatrix normal = LocalMatrix(equations.a.transpose()) * equations.a;
  const Eigen::Index unknowns = normal.cols();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const LocalMatrix& block, Eigen::Index below, bool transposed) {
    for (Eigen::Index j = 0; j < block.outerSize(); ++j) {
      for (LocalMatrix::InnerIterator entry(block, j); entry; ++entry) {
        const Eigen::Index i = entry.row() + below;
        entries.emplace_back(static_cast<Index>(transposed ? j : i), static_cast<Index>(transposed ? i : j),
                             entry.value());
      }
    }
  };
  add(normal, 0, false);
  add(equations.exact, unknowns, false);
  add(equations.exact, unknowns, true);
  const Eigen::Index size = unknowns + equations.exact.rows();
  LocalMatrix saddle(size, size);
  saddle.setFromTriplets(entries.begin(), entries.end());
  return saddle;
}

}  // namespace

std::vector<Index> places_within(LocalRows& rows, std::span<const Index> changed, int rings) {
  const Topology& topology = rows.matrix().topology();
  std::vector<Index> places;
  for (const Index v : changed) places.push_back(rows.place_of(v));
  std::size_t begin = 0;
  for (int ring = 0; ring < rings && begin < places.size(); ++ring) {
    const std::size_t end = places.size();
    for (; begin < end; ++begin) {
      topology.for_each_outgoing(rows.vertex(places[begin]), [&](Index h) {
        const Index f = topology.face(h);
        for (Index i = topology.face_begin(f); i < topology.face_end(f); ++i) {
          const Index before = rows.size();
          const Index place = rows.place_of(topology.origin(i));
          if (place == before) places.push_back(place);
        }
      });
    }
  }
  return places;
}

LocalFit fit_locally(LocalRows& rows, std::vector<Index> places, std::size_t exact, ConstValuesRef targets,
                     ConstValuesRef control, const Progress& progress) {
  LocalFit fit{std::move(places), {}, Values(0, targets.cols())};
  if (fit.places.empty()) return fit;
  fit.affected = affected_places(rows, fit.places);
  const LocalEquations equations = make_equations(rows, fit.places, fit.affected, exact, targets, control);
  const auto unknowns = static_cast<Eigen::Index>(fit.places.size());
  const LocalMatrix saddle = saddle_matrix(equations);
  Eigen::MatrixXd right(saddle.rows(), targets.cols());
  right << equations.a.transpose() * equations.b, equations.b.topRows(static_cast<Eigen::Index>(exact));
  report_progress(progress, 0.2);
  const Eigen::SparseLU<LocalMatrix> factors(saddle);
  if (factors.info() != Eigen::Success) refuse_rings();
  report_progress(progress, 0.9);
  Eigen::MatrixXd solution = factors.solve(right);
  solution += Eigen::MatrixXd(factors.solve(Eigen::MatrixXd(right - saddle * solution)));
  if (!solution.allFinite()) refuse_rings();
  fit.change = solution.topRows(unknowns);
  return fit;
}

}  // namespace batten
