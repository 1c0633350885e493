#include "batten/solve/incomplete_factor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// What the scaled diagonal of ones grows by where a pivot is not positive; twice as much each time. With a smaller one
/// pivots are barely positive, which doubles the iterations (docs/decisions/011-fair-solver.md).
constexpr double kShift = 5e-2;
/// Next to a diagonal of this size no entry of a scaled positive definite matrix counts.
constexpr double kMostShift = 1e9;
constexpr double kLeastPivot = 1e-10;
constexpr int kMostParts = 8;

/// For each row, one more than the last column that it or a row before it has.
Buffer<int> reaches(const IncompleteFactor::Matrix& matrix) {
  Buffer<int> result;
  int reach = 0;
  for (int i = 0; i < static_cast<int>(matrix.rows()); ++i) {
    const int end = matrix.outerIndexPtr()[i + 1];
    if (end > matrix.outerIndexPtr()[i]) reach = std::max(reach, matrix.innerIndexPtr()[end - 1] + 1);
    result.push_back(reach);
  }
  return result;
}

}  // namespace

IncompleteFactor::IncompleteFactor(const Matrix& matrix, int least_rows) {
  cut(matrix, least_rows);
  count_entries(matrix);
  for (double shift = 0.0; !factorise(matrix, shift); shift = std::max(kShift, 2.0 * shift)) {
    if (shift > kMostShift) throw Error(ErrorCode::NotFinite, "the system has numbers that are not finite");
  }
}

/// Rows from `begin` up to what the rows before reach stand between two parts. The next cut is so far on that no two
/// ranges between parts have an entry in common.
void IncompleteFactor::cut(const Matrix& matrix, int least_rows) {
  const auto count = static_cast<int>(matrix.rows());
  const Buffer<int> reach = reaches(matrix);
  const int part = std::max(least_rows, count / kMostParts);
  std::vector<Range> parts;
  std::vector<Range> between;
  int first = 0;
  int between_rows = 0;
  for (int begin = part; begin < count - part / 2;) {
    const int end = reach[begin - 1];
    if (end >= count || reach[end - 1] >= count) break;
    parts.push_back({first, begin});
    between.push_back({begin, end});
    between_rows += end - begin;
    first = end;
    begin = std::max(end + part, reach[end - 1]);
  }
  // Where a quarter of the rows stood between parts the band is too wide.
  if (4 * static_cast<std::ptrdiff_t>(between_rows) > count) {
    parts.clear();
    between.clear();
    first = 0;
  }
  parts.push_back({first, count});
  rows_.reserve(static_cast<std::size_t>(count));
  const auto append = [&](const std::vector<Range>& ranges, std::vector<Range>& result) {
    for (const Range& range : ranges) {
      const auto place = static_cast<int>(rows_.size());
      result.push_back({place, place + range.end - range.begin});
      for (int i = range.begin; i < range.end; ++i) rows_.push_back(i);
    }
  };
  append(parts, parts_);
  append(between, between_);
  places_.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) places_[rows_[i]] = i;
}

/// Calls visit(column, value) for the matrix's entries in a row of L, its diagonal last. Within a part columns stand as
/// in the matrix; in a row between two parts those of the parts come first.
template <typename Visit>
void IncompleteFactor::visit_row(const Matrix& matrix, const Range& range, int row, const Visit& visit) const {
  const int own = rows_[row];
  if (row < between_begin()) {
    const int first = rows_[range.begin];
    for (Matrix::InnerIterator entry(matrix, own); entry && entry.col() <= own; ++entry) {
      if (entry.col() >= first) visit(range.begin + static_cast<int>(entry.col()) - first, entry.value());
    }
    return;
  }
  for (const bool is_between : {false, true}) {
    for (Matrix::InnerIterator entry(matrix, own); entry; ++entry) {
      const int column = places_[entry.col()];
      if (column <= row && (column >= between_begin()) == is_between) visit(column, entry.value());
    }
  }
}

/// Where the rows of L begin.
void IncompleteFactor::count_entries(const Matrix& matrix) {
  const std::size_t count = rows_.size();
  scale_.resize(count);
  starts_.assign(count + 1, 0);
  for (const std::vector<Range>* ranges : {&parts_, &between_}) {
    parallel_for_each(static_cast<std::ptrdiff_t>(ranges->size()), [&](std::ptrdiff_t r) {
      const Range& range = (*ranges)[static_cast<std::size_t>(r)];
      for (int i = range.begin; i < range.end; ++i) {
        int entries = 0;
        double diagonal = 0.0;
        visit_row(matrix, range, i, [&](int /*column*/, double value) {
          ++entries;
          diagonal = value;
        });
        starts_[i + 1] = entries;
        scale_[i] = 1.0 / std::sqrt(diagonal);
      }
    });
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  columns_.resize(static_cast<std::size_t>(starts_.back()));
  weights_.resize(columns_.size());
  bounds_.resize(2 * (count - static_cast<std::size_t>(between_begin())));
}

/// The matrix's lower triangle in the rows of L. right: where the part on the right of rows between two parts begins.
void IncompleteFactor::copy_entries(const Matrix& matrix, const Range& range, int right) {
  for (int i = range.begin; i < range.end; ++i) {
    int next = starts_[i];
    visit_row(matrix, range, i, [&](int column, double value) {
      columns_[next] = column;
      weights_[next++] = value * scale_[i] * scale_[column];
    });
    if (i < between_begin()) continue;
    int* const bound = bounds_.data() + 2 * static_cast<std::size_t>(i - between_begin());
    const auto place = [&](int column) {
      return static_cast<int>(std::lower_bound(columns_.data() + starts_[i], columns_.data() + next, column) -
                              columns_.data());
    };
    bound[0] = place(right);
    bound[1] = place(between_begin());
  }
}

bool IncompleteFactor::factorise(const Matrix& matrix, double shift) {
  for (const std::vector<Range>* ranges : {&parts_, &between_}) {
    Buffer<std::uint8_t> sound(ranges->size(), 0);
    parallel_for_each(static_cast<std::ptrdiff_t>(ranges->size()), [&](std::ptrdiff_t r) {
      const Range& range = (*ranges)[static_cast<std::size_t>(r)];
      copy_entries(matrix, range, ranges == &between_ ? parts_[static_cast<std::size_t>(r) + 1].begin : 0);
      sound[r] = factorise(shift, range) ? 1 : 0;
    });
    if (std::find(sound.begin(), sound.end(), 0) != sound.end()) return false;
  }
  return true;
}

/// Row by row: l_ik = (a_ik - sum over j < k of l_ij l_kj) / l_kk, of the entries that the matrix has. False where a
/// pivot is not positive.
bool IncompleteFactor::factorise(double shift, const Range& range) {
  // A part's columns are its own.
  const int first = range.begin < between_begin() ? range.begin : 0;
  Buffer<double> numbers(static_cast<std::size_t>(range.end - first), 0.0);
  double* const row = numbers.data() - first;
  for (int i = range.begin; i < range.end; ++i) {
    const int begin = starts_[i];
    const int last = starts_[i + 1] - 1;
    double pivot = 1.0 + shift;
    for (int e = begin; e < last; ++e) {
      const int k = columns_[e];
      double even = weights_[e];
      double odd = 0.0;
      int f = starts_[k];
      const int diagonal = starts_[k + 1] - 1;
      for (; f + 1 < diagonal; f += 2) {
        even -= weights_[f] * row[columns_[f]];
        odd -= weights_[f + 1] * row[columns_[f + 1]];
      }
      if (f < diagonal) even -= weights_[f] * row[columns_[f]];
      const double weight = (even + odd) * weights_[diagonal];
      weights_[e] = weight;
      row[k] = weight;
      pivot -= weight * weight;
    }
    for (int e = begin; e < last; ++e) row[columns_[e]] = 0.0;
    if (!(pivot > kLeastPivot)) return false;
    weights_[last] = 1.0 / std::sqrt(pivot);
  }
  return true;
}

/// L x = b for some rows; those that they depend on beyond the range are solved already.
void IncompleteFactor::eliminate(const Range& range, Buffer<Double4>& x) const {
  for (int i = range.begin; i < range.end; ++i) {
    Double4 even = x[i];
    Double4 odd{};
    const int diagonal = starts_[i + 1] - 1;
    int e = starts_[i];
    for (; e + 1 < diagonal; e += 2) {
      even -= weights_[e] * x[columns_[e]];
      odd -= weights_[e + 1] * x[columns_[e + 1]];
    }
    if (e < diagonal) even -= weights_[e] * x[columns_[e]];
    x[i] = (even + odd) * weights_[diagonal];
  }
}

/// L^T x = b for the rows between two parts.
void IncompleteFactor::substitute_between(const Range& range, Buffer<Double4>& x) const {
  for (int i = range.end - 1; i >= range.begin; --i) {
    const int diagonal = starts_[i + 1] - 1;
    const Double4 value = x[i] * weights_[diagonal];
    x[i] = value;
    for (int e = bounds(i)[1]; e < diagonal; ++e) x[columns_[e]] -= weights_[e] * value;
  }
}

/// What solved rows take from the part on their left or right.
void IncompleteFactor::take_from_part(const Range& between, bool is_left, Buffer<Double4>& x) const {
  for (int i = between.begin; i < between.end; ++i) {
    const int begin = is_left ? starts_[i] : bounds(i)[0];
    const int end = bounds(i)[is_left ? 0 : 1];
    for (int e = begin; e < end; ++e) x[columns_[e]] -= weights_[e] * x[i];
  }
}

/// L^T x = b for the rows of a part, once those beside it are solved.
void IncompleteFactor::substitute_part(int part, Buffer<Double4>& x) const {
  if (part > 0) take_from_part(between_[static_cast<std::size_t>(part) - 1], false, x);
  if (part + 1 < part_count()) take_from_part(between_[static_cast<std::size_t>(part)], true, x);
  const Range& range = parts_[static_cast<std::size_t>(part)];
  for (int i = range.end - 1; i >= range.begin; --i) {
    const int diagonal = starts_[i + 1] - 1;
    const Double4 value = x[i] * weights_[diagonal];
    x[i] = value;
    for (int e = starts_[i]; e < diagonal; ++e) x[columns_[e]] -= weights_[e] * value;
  }
}

void IncompleteFactor::solve(const Values& b, Values& x) const {
  x.resize(b.rows(), b.cols());
  Buffer<Double4> four = spare_.take();
  four.resize(static_cast<std::size_t>(b.rows()));
  const auto each = [](const std::vector<Range>& ranges, const auto& body) {
    parallel_for_each(static_cast<std::ptrdiff_t>(ranges.size()),
                      [&](std::ptrdiff_t r) { body(static_cast<int>(r), ranges[static_cast<std::size_t>(r)]); });
  };
  for (Eigen::Index first = 0; first < b.cols(); first += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, b.cols() - first);
    const auto load = [&](const Range& range) {
      for (int i = range.begin; i < range.end; ++i) {
        Double4 row{};
        for (Eigen::Index c = 0; c < columns; ++c) row[c] = b(rows_[i], first + c) * scale_[i];
        four[i] = row;
      }
    };
    const auto store = [&](const Range& range) {
      for (int i = range.begin; i < range.end; ++i) {
        for (Eigen::Index c = 0; c < columns; ++c) x(rows_[i], first + c) = four[i][c] * scale_[i];
      }
    };
    each(parts_, [&](int /*part*/, const Range& range) {
      load(range);
      eliminate(range, four);
    });
    each(between_, [&](int /*place*/, const Range& range) {
      load(range);
      eliminate(range, four);
      substitute_between(range, four);
      store(range);
    });
    each(parts_, [&](int part, const Range& range) {
      substitute_part(part, four);
      store(range);
    });
  }
  spare_.give_back(std::move(four));
}

}  // namespace batten
