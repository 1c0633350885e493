#include "batten/patch/ring_types.h"

#include <algorithm>
#include <optional>

#include "batten/refine/child_topology.h"
#include "batten/refine/refined_rows.h"
#include "batten/scheme/masks.h"

namespace batten {

namespace {

/// The children that are no rings at the pole need the faces so near to the ring's own.
constexpr int kLeastPoleWidth = 2;

void append_row(const SparseRows& matrix, Index row, SparseRows& rows) {
  for (Index e = matrix.starts[row]; e < matrix.starts[row + 1]; ++e) rows.add(matrix.columns[e], matrix.weights[e]);
  rows.end_row();
}

/// The given rows of a matrix; missing ones are empty.
template <typename Rows>
SparseRows rows_of(const SparseRows& matrix, const Rows& rows, std::size_t count) {
  SparseRows chosen;
  for (std::size_t r = 0; r < count; ++r) {
    if (rows[r] < 0) {
      chosen.end_row();
    } else {
      append_row(matrix, rows[r], chosen);
    }
  }
  return chosen;
}

/// Collects rows of a matrix, each once.
class RowCollector {
 public:
  explicit RowCollector(const SparseRows& matrix)
      : matrix_(matrix), numbers_(static_cast<std::size_t>(matrix.count()), RegularPatch::kMissing) {}

  Index number_of(Index row) {
    if (numbers_[row] == RegularPatch::kMissing) {
      append_row(matrix_, row, rows_);
      numbers_[row] = rows_.count() - 1;
    }
    return numbers_[row];
  }

  /// The points of a patch; those that are missing are rows of their own.
  Buffer<Index> patch(const RegularPatch& patch, bool quads) {
    const auto count = static_cast<std::size_t>(patch_size(quads));
    Buffer<Index> columns;
    for (std::size_t i = 0; i < count; ++i) {
      const Index row = patch.rows[i];
      if (row == RegularPatch::kMissing) continue;
      columns.insert(columns.end(), &matrix_.columns[matrix_.starts[row]], &matrix_.columns[matrix_.starts[row + 1]]);
    }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const Values points = completed(patch, columns, quads);
    Buffer<Index> numbers;
    for (std::size_t i = 0; i < count; ++i) {
      const bool missing = patch.rows[i] == RegularPatch::kMissing;
      numbers.push_back(missing ? add(points.row(static_cast<Eigen::Index>(i)), columns) : number_of(patch.rows[i]));
    }
    return numbers;
  }

  SparseRows take() { return std::move(rows_); }

 private:
  /// All points of a patch, on these columns.
  Values completed(const RegularPatch& patch, const Buffer<Index>& columns, bool quads) const {
    const auto width = static_cast<int>(columns.size());
    const int count = patch_size(quads);
    Values points = Values::Zero(count, width);
    for (int i = 0; i < count; ++i) {
      const Index row = patch.rows[i];
      if (row == RegularPatch::kMissing) continue;
      for (Index e = matrix_.starts[row]; e < matrix_.starts[row + 1]; ++e) {
        const auto place = std::lower_bound(columns.begin(), columns.end(), matrix_.columns[e]) - columns.begin();
        points(i, place) = matrix_.weights[e];
      }
    }
    complete_patch(quads, patch.rows.data(), points.data(), width);
    return points;
  }

  Index add(const Eigen::Ref<const Eigen::RowVectorXd>& weights, const Buffer<Index>& columns) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double weight = weights[static_cast<Eigen::Index>(c)];
      if (weight != 0.0) rows_.add(columns[c], weight);
    }
    rows_.end_row();
    return rows_.count() - 1;
  }

  const SparseRows& matrix_;
  Buffer<Index> numbers_;
  SparseRows rows_;
};

/// The rows of a step for a ring at a pole. They follow from those of its cutting, in which the pole is open: its own
/// row and those of its means are the means of all its faces' rows.
class PoleRows {
 public:
  PoleRows(const FaceRing& ring, const Topology& cutting, const Scheme& scheme)
      : ring_(ring),
        corners_(cutting.face_size(0)),
        means_(corners_ - 2),
        kinds_(static_cast<std::size_t>(cutting.vertex_count()), Kind::Other) {
    const Index side = cutting.face_begin(0) + ring.pole_corner();
    find_kinds(cutting, side);
    const SparseRows refined = refined_rows(cutting, scheme);
    const Index edge_row = cutting.vertex_count() + cutting.edge(side);
    e_ = mean(refined, edge_row);
    if (means_ > 1) f_ = mean(refined, cutting.vertex_count() + cutting.edge_count());
    const SmoothMask mask = vertex_mask(scheme.kind, ring.pole_faces());
    Weights pole{mask.vertex, ring.pole_faces() * mask.edge, 0.0};
    for (std::size_t k = 0; k < pole.size(); ++k) pole[k] += ring.pole_faces() * mask.face * f_[k];
    for (Index r = 0; r < refined.count(); ++r) {
      if (r == ring.pole_corner()) {
        add(pole);
      } else {
        add(refined, r);
      }
    }
    add(e_);
    if (means_ > 1) add(f_);
  }

  /// Rows of refined vertices, then of the means; columns are the points of the ring.
  const SparseRows& rows() const { return rows_; }
  /// The row of the mean of a point of the ring that is far around the pole.
  Index mean_row(std::size_t point) const {
    const bool e = kinds_[point - static_cast<std::size_t>(means_)] == Kind::E;
    return rows_.count() - (e ? means_ : 1);
  }

 private:
  enum class Kind : std::uint8_t { Other, Pole, E, F };
  using Weights = std::array<double, 3>;  ///< of the pole and of its means

  void find_kinds(const Topology& cutting, Index side) {
    kinds_[cutting.origin(side)] = Kind::Pole;
    const auto add_sector = [&](Index h) {
      kinds_[cutting.destination(h)] = Kind::E;
      kinds_[cutting.origin(cutting.previous(h))] = Kind::E;
      if (means_ > 1) kinds_[cutting.destination(cutting.next(h))] = Kind::F;
    };
    add_sector(side);
    Index left = side;
    Index right = side;
    for (int i = 0; i < ring_.width(); ++i) {
      add_sector(left = cutting.twin(cutting.previous(left)));
      add_sector(right = cutting.next(cutting.twin(right)));
    }
  }
  Weights mean(const SparseRows& refined, Index row) const {
    Weights sum{};
    for (Index e = refined.starts[row]; e < refined.starts[row + 1]; ++e) {
      const Kind kind = kinds_[refined.columns[e]];
      sum[kind == Kind::Pole ? 0 : kind == Kind::E ? 1 : 2] += refined.weights[e];
    }
    return sum;
  }
  void add(const Weights& weights) {
    rows_.add(ring_.pole_corner(), weights[0]);
    for (Index m = 0; m < means_; ++m) rows_.add(corners_ + m, weights[m + 1]);
    rows_.end_row();
  }
  void add(const SparseRows& refined, Index row) {
    for (Index e = refined.starts[row]; e < refined.starts[row + 1]; ++e) {
      const Index column = refined.columns[e];
      rows_.add(column < corners_ ? column : column + means_, refined.weights[e]);
    }
    rows_.end_row();
  }

  const FaceRing& ring_;
  Index corners_;
  Index means_;
  std::vector<Kind> kinds_;
  Weights e_{};
  Weights f_{};
  SparseRows rows_;
};

}  // namespace

RingTypes::RingTypes(const Scheme& scheme) : scheme_(scheme.after_first_step()) {}

Index RingTypes::add_type(const FaceRing& ring) {
  const auto type = static_cast<Index>(types_.size());
  numbers_.emplace(ring.key(), type);
  types_.emplace_back();
  steps_.emplace_back();
  poles_.emplace_back();
  if (ring.pole_corner() < 0) return type;
  const auto known = family_numbers_.emplace(ring.family(), static_cast<Index>(families_.size()));
  if (known.second) families_.emplace_back(static_cast<std::size_t>(Poles::kWidth) + 1, -1);
  poles_[type] = {known.first->second, ring.width()};
  families_[poles_[type].family][ring.width()] = type;
  return type;
}

Index RingTypes::narrowed(Index type, int halvings) const {
  const PoleType& pole = poles_[type];
  const int width = std::max(halvings, 1) + kLeastPoleWidth - 1;
  if (pole.family < 0 || width >= pole.width) return type;
  const Index narrow = families_[pole.family][width];
  return narrow < 0 ? type : narrow;
}

Index RingTypes::type_of(const Topology& topology, const FaceRing& ring) {
  const auto place = numbers_.find(ring.key());
  if (place != numbers_.end()) return place->second;
  const Index type = add_type(ring);
  // The face is face 0 of the cutting, and its vertices stand in the ring's order.
  const Cutting cutting = cut_out(topology, ring.half_edges());
  const Topology child = child_topology(cutting.topology, scheme_);
  const bool at_pole = ring.pole_corner() >= 0;
  std::optional<PoleRows> pole_rows;
  if (at_pole) pole_rows.emplace(ring, cutting.topology, scheme_);
  const SparseRows refined = at_pole ? pole_rows->rows() : refined_rows(cutting.topology, scheme_);
  const Poles poles = at_pole ? Poles(child, ring.pole_corner(), ring.pole_faces()) : Poles();
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  // The side of each child that runs along u (a middle triangle's: against it).
  static constexpr Index kQuadSides[4] = {0, 4 + 3, 8 + 2, 12 + 1};
  static constexpr Index kTriangleSides[4] = {0, 3 + 2, 6 + 1, 9 + 1};
  const PatchFinder finder(child, scheme_);
  std::vector<Child> children(4);
  RowCollector collector(refined);
  Step step;
  step.ring_size = static_cast<Index>(ring.points().size());
  for (int c = 0; c < 4; ++c) {
    Child& result = children[c];
    const Index side = quads ? kQuadSides[c] : kTriangleSides[c];
    // In the cutting a pole is open, and has any number of faces.
    if (c != ring.pole_corner() && finder.find(side, result.patch)) {
      result.type = kPatch;
      step.children[c] = collector.patch(result.patch, quads);
      result.rows = rows_of(refined, result.patch.rows, patch_size(quads));
      continue;
    }
    FaceRing own;
    own.gather(child, scheme_, side, poles, ring.width() - 1);
    result.rows = rows_of(refined, own.points(), own.points().size());
    for (const Index v : own.points()) step.children[c].push_back(collector.number_of(v));
    if (own.pole_corner() >= 0 && own.width() < kLeastPoleWidth) {
      // What is missing of the ring stands at the means: it is no larger than rounding.
      for (std::size_t p = own.points().size(); p < ring.points().size(); ++p) {
        append_row(refined, pole_rows->mean_row(p), result.rows);
        step.children[c].push_back(collector.number_of(pole_rows->mean_row(p)));
      }
      result.type = type;
    } else {
      result.type = type_of(child, own);
    }
  }
  step.rows = collector.take();
  types_[type] = std::move(children);
  steps_[type] = std::move(step);
  return type;
}

}  // namespace batten
