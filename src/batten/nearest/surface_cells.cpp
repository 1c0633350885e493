#include "batten/nearest/surface_cells.h"

#include <algorithm>

#include "batten/parallel/parallel.h"
#include "batten/patch/level_values.h"

namespace batten {

namespace {

/// A regular cell that bends more is halved. A smaller limit would take memory, a larger one makes searches halve.
constexpr double kMostBend = 0.3;

}  // namespace

template <typename Net>
SurfaceCells<Net>::SurfaceCells(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress)
    : patches_(patches), shapes_(patches), limit_matrix_(patches.base(), patches.base_scheme()) {
  constexpr double kCut = 0.3;
  constexpr double kChosen = 0.4;
  constexpr double kSorted = 0.75;
  report_progress(progress, kCut);
  control_ = control_of(control);
  choose_cells(progress_within(progress, kCut, kChosen));
  sort_cells(progress_within(progress, kChosen, kSorted));
  tree_ = BoxTree(cell_count());
  fit(control_, tree_, progress_within(progress, kSorted, 1.0));
}

template <typename Net>
void SurfaceCells<Net>::set_control(ConstValuesRef control, const Progress& progress) {
  constexpr double kRefined = 0.1;
  report_progress(progress, 0.0);
  Control moved = control_of(control);
  if (spare_.box_count() != cell_count()) spare_ = BoxTree(cell_count());
  fit(moved, spare_, progress_within(progress, kRefined, 1.0));
  std::swap(control_, moved);
  std::swap(tree_, spare_);
}

template <typename Net>
typename SurfaceCells<Net>::Control SurfaceCells<Net>::control_of(ConstValuesRef values) const {
  const Values base_values = patches_.base_values(values);
  Control control;
  control.levels = level_points(patches_, base_values);
  control.limits = vectors_of(limit_matrix_.apply(base_values));
  const Eigen::RowVector3d middle = 0.5 * (base_values.colwise().minCoeff() + base_values.colwise().maxCoeff());
  control.centre = Double4{middle[0], middle[1], middle[2], 0.0};
  const double size = (base_values.rowwise() - middle).cwiseAbs().maxCoeff();
  if (size > 0.0) control.scale = 1.0 / size;
  return control;
}

/// Returns the number of points.
template <typename Net>
Index SurfaceCells<Net>::gather(const Control& control, const Piece& piece, const Double4& origin,
                                Scratch& scratch) const {
  const Double4* values = control.levels[piece.level].data();
  Double4* points = scratch.control.data();
  if (piece.kind != Piece::Kind::Patch) {
    const std::span<const Index> ring = patches_.pieces().ring(piece, scratch.ring);
    for (std::size_t i = 0; i < ring.size(); ++i) points[i] = values[ring[i]] - origin;
    return static_cast<Index>(ring.size());
  }
  const Index* rows = patches_.pieces().rows(piece);
  bool complete = true;
  for (Index i = 0; i < Net::kSplinePoints; ++i) {
    if (rows[i] == RegularPatch::kMissing) {
      complete = false;
    } else {
      points[i] = values[rows[i]] - origin;
    }
  }
  if (!complete) complete_patch<Net>(rows, points);
  return Net::kSplinePoints;
}

template <typename Net>
Placement SurfaceCells<Net>::placement(const Cell& cell) const {
  const Piece& piece = patches_.pieces().begin(0)[cell.piece];
  const double step = 1.0 / static_cast<double>(Index{1} << patches_.pieces().levels());
  const Placement at{piece.x * step, piece.y * step, (piece.turned ? -step : step) * piece.size};
  return at.of(shapes_.shape(cell.shape).placement);
}

/// How many times a regular piece is halved: each halving halves the bend.
template <typename Net>
int SurfaceCells<Net>::halvings(const Piece& piece, Scratch& scratch) const {
  std::array<Double4, Net::kPoints> net;
  gather(control_, piece, control_.centre, scratch);
  spline_matrix<Net>().apply(scratch.control.data(), net.data());
  double bend = NetFrame<Net>(net.data()).bend();
  int count = 0;
  for (; bend > kMostBend && count < CellShapes<Net>::kMostHalvings; bend *= 0.5) ++count;
  return count;
}

template <typename Net>
void SurfaceCells<Net>::choose_cells(const Progress& progress) {
  const Buffer<std::uint8_t>& holes = patches_.holes();
  const Piece* pieces = patches_.pieces().begin(0);
  const auto count = static_cast<Index>(patches_.pieces().end(base().face_count() - 1) - pieces);
  Buffer<typename CellShapes<Net>::Range> ranges(static_cast<std::size_t>(count));
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Scratch scratch(most_points());
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Piece& piece = pieces[i];
          if (!holes.empty() && holes[piece.face] != 0) {
            ranges[i] = {0, 0};
          } else if (piece.kind == Piece::Kind::Patch) {
            ranges[i] = shapes_.regular(halvings(piece, scratch));
          } else {
            ranges[i] = shapes_.irregular(piece.shared_ring);
          }
        }
      },
      1024, progress);
  std::size_t cell_count = 0;
  for (const auto& range : ranges) cell_count += static_cast<std::size_t>(range.count);
  cells_.reserve(cell_count);
  for (Index i = 0; i < count; ++i) {
    for (Index k = 0; k < ranges[i].count; ++k) cells_.push_back({i, ranges[i].first + k});
  }
}

/// Brings the cells into the order of the tree.
template <typename Net>
void SurfaceCells<Net>::sort_cells(const Progress& progress) {
  constexpr double kMiddles = 0.5;  // of the time
  Buffer<BoxMiddle> middles(cells_.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(cells_.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Bounds bounds(most_points());
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          find_bounds(control_, cells_[i], bounds);
          Double4 low = bounds.hull[0];
          Double4 high = bounds.hull[0];
          for (const Double4& point : bounds.hull) {
            low = lower(low, point);
            high = higher(high, point);
          }
          for (int c = 0; c < 3; ++c) middles[i].at[c] = static_cast<float>(0.5 * (low[c] + high[c]));
          middles[i].box = static_cast<Index>(i);
        }
      },
      512, progress_within(progress, 0.0, kMiddles));
  report_progress(progress, kMiddles);
  sort_for_tree(middles);
  Buffer<Cell> sorted(cells_.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = cells_[middles[i].box];
  // Any order within a leaf will do: cells of the same piece share its control points.
  for (std::size_t first = 0; first < sorted.size(); first += BoxTree::kFanout) {
    const std::size_t last = std::min(first + BoxTree::kFanout, sorted.size());
    std::sort(sorted.begin() + first, sorted.begin() + last,
              [](const Cell& a, const Cell& b) { return a.piece != b.piece ? a.piece < b.piece : a.shape < b.shape; });
  }
  cells_ = std::move(sorted);
}

/// Sets the boxes of a tree: they depend on the control points and the cells alone, not on what the tree held before.
template <typename Net>
void SurfaceCells<Net>::fit(const Control& control, BoxTree& tree, const Progress& progress) const {
  parallel_for(
      tree.leaf_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Bounds bounds(most_points());
        std::array<CellBox, BoxTree::kFanout> boxes;
        for (std::ptrdiff_t leaf = begin; leaf < end; ++leaf) {
          const Index first = static_cast<Index>(leaf) * BoxTree::kFanout;
          const auto count = static_cast<std::size_t>(std::min<Index>(BoxTree::kFanout, cell_count() - first));
          for (std::size_t i = 0; i < count; ++i) {
            find_bounds(control, cells_[first + i], bounds);
            boxes[i] = cell_box_of(bounds.hull, bounds.along, bounds.across);
          }
          tree.set_leaf(static_cast<Index>(leaf), {boxes.data(), count});
        }
      },
      64, progress);
  tree.bound_nodes();
}

/// A ring's hull is much larger than its face, so the ring is halved a few times.
template <typename Net>
void SurfaceCells<Net>::find_bounds(const Control& control, const Cell& cell, Bounds& bounds) const {
  if (cell.piece != bounds.piece) {
    const Piece& piece = patches_.pieces().begin(0)[cell.piece];
    const Index count = gather(control, piece, control.centre, bounds.scratch);
    for (Index i = 0; i < count; ++i) bounds.scratch.control[i] *= control.scale;
    bounds.piece = cell.piece;
  }
  Double4* points = bounds.points.data();
  shapes_.points(cell.shape, bounds.scratch.control.data(), points);
  const CellShape& cell_shape = shape(cell);
  if (cell_shape.type == RingTypes::kPatch) {
    bounds.hull = {points, static_cast<std::size_t>(Net::kPoints)};
    bounds.along = Net::mean_du(points);
    bounds.across = Net::mean_dv(points);
    return;
  }
  bounds.of_ring.clear();
  add_ring_bounds(cell_shape.type, points, kBoundLevels, bounds);
  bounds.hull = bounds.of_ring;
  bounds.along = points[1] - points[0];  // the ring begins with the corners of its face
  bounds.across = points[Net::kCorners - 1] - points[0];
}

/// All four children's points are worked out at once, since they have many in common.
template <typename Net>
void SurfaceCells<Net>::add_ring_bounds(Index type, const Double4* ring, int levels, Bounds& bounds) const {
  const RingTypes::Step& step = patches_.ring_types().step(type);
  std::vector<Double4>& points = bounds.steps[static_cast<std::size_t>(levels - 1)];
  points.resize(static_cast<std::size_t>(step.rows.count()));
  combine_rows(step.rows, ring, points.data());
  for (int number = 0; number < 4; ++number) {
    const Buffer<Index>& places = step.children[number];
    const Index child = patches_.ring_types().child(type, number).type;
    std::vector<Double4>& own = bounds.child;
    own.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) own[i] = points[places[i]];
    if (child == RingTypes::kPatch) {
      bounds.of_ring.resize(bounds.of_ring.size() + Net::kPoints);
      spline_matrix<Net>().apply(own.data(), &bounds.of_ring[bounds.of_ring.size() - Net::kPoints]);
    } else if (levels == 1) {
      bounds.of_ring.insert(bounds.of_ring.end(), own.begin(), own.end());
    } else {
      add_ring_bounds(child, own.data(), levels - 1, bounds);
    }
  }
}

template class SurfaceCells<QuadNet>;
template class SurfaceCells<TriangleNet>;

}  // namespace batten
