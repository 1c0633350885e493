#include "batten/nearest/surface_cells.h"

#include <algorithm>

#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/level_values.h"

namespace batten {

namespace {

/// Irregular faces are halved so often before rings are left to the search.
constexpr int kRingLevels = 3;
/// Where a regular cell bends more, halves are made of it. Less would take memory, more makes searches halve.
constexpr double kMostBend = 0.3;
/// For their boxes rings are halved so often.
constexpr int kBoundLevels = 2;

template <typename Net>
void complete_net_patch(const Index* rows, double* points, int columns) {
  complete_patch(std::is_same_v<Net, QuadNet>, rows, points, columns);
}

Buffer<Double4> vectors_of(ConstValuesRef values) {
  Buffer<Double4> vectors(static_cast<std::size_t>(values.rows()));
  parallel_for(values.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) vectors[i] = Double4{values(i, 0), values(i, 1), values(i, 2), 0.0};
  });
  return vectors;
}

/// Rounded to the nearest float: BoxTree allows for that.
FloatBox box_of(const std::vector<Double4>& points) {
  Double4 low = points[0];
  Double4 high = points[0];
  for (const Double4& point : points) {
    low = lower(low, point);
    high = higher(high, point);
  }
  FloatBox box;
  for (int c = 0; c < 3; ++c) {
    box.low[c] = static_cast<float>(low[c]);
    box.high[c] = static_cast<float>(high[c]);
  }
  return box;
}

}  // namespace

template <typename Net>
CellShapes<Net>::CellShapes(const Pieces& pieces, RingSteps& steps) {
  const NetTables<Net>& tables = net_tables<Net>();
  Matrix patch{Net::kPoints, Net::kSplinePoints, {}};
  for (const auto& row : tables.from_spline) patch.weights.insert(patch.weights.end(), row.begin(), row.end());
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
    const auto first = static_cast<Index>(shapes_.size());
    add_regular(patch, {}, halvings);
    regular_[halvings] = {first, static_cast<Index>(shapes_.size()) - first};
  }
  FaceRing ring;
  for (const Pieces::SharedRing& configuration : pieces.shared_rings()) {
    ring.gather(configuration.topology, pieces.scheme(), 0);
    const Index kind = steps.type_of(configuration.topology, ring);
    const Index count = configuration.topology.vertex_count();
    Matrix identity{count, count,
                    Buffer<double>(static_cast<std::size_t>(count) * static_cast<std::size_t>(count), 0.0)};
    for (Index i = 0; i < count; ++i) identity.weights[static_cast<std::size_t>(i) * (count + 1)] = 1.0;
    int levels = kRingLevels;
    for (Index size = configuration.size; size < (Index{1} << pieces.levels()); size *= 2) --levels;
    const auto first = static_cast<Index>(shapes_.size());
    add_ring(steps, kind, identity, {}, std::max(levels, 1));
    irregular_.push_back({first, static_cast<Index>(shapes_.size()) - first});
  }
}

template <typename Net>
void CellShapes<Net>::add_shape(const Placement& placement, Index kind, const Matrix& matrix) {
  shapes_.push_back({placement, kind, matrix.rows, matrix.columns, matrix.weights});
  most_points_ = std::max({most_points_, matrix.rows, matrix.columns});
}

template <typename Net>
void CellShapes<Net>::add_regular(const Matrix& net, const Placement& placement, int halvings) {
  if (halvings == 0) {
    add_shape(placement, RingSteps::kPatch, net);
    return;
  }
  for (int child = 0; child < 4; ++child) {
    const auto& half_weights = net_tables<Net>().halves[child];
    Matrix part{net.rows, net.columns, Buffer<double>(net.weights.size(), 0.0)};
    for (Index r = 0; r < net.rows; ++r) {
      for (Index k = 0; k < net.rows; ++k) {
        for (Index c = 0; c < net.columns; ++c)
          part.weights[r * net.columns + c] += half_weights[r][k] * net.weights[k * net.columns + c];
      }
    }
    add_regular(part, placement.of(half<Net>(child)), halvings - 1);
  }
}

template <typename Net>
void CellShapes<Net>::add_ring(const RingSteps& steps, Index kind, const Matrix& ring, const Placement& placement,
                               int levels) {
  if (levels == 0) {
    add_shape(placement, kind, ring);
    return;
  }
  const Index columns = ring.columns;
  for (int number = 0; number < 4; ++number) {
    const RingSteps::Child& child = steps.child(kind, number);
    const SparseRows& rows = child.rows;
    Matrix part{rows.count(), columns, Buffer<double>(static_cast<std::size_t>(rows.count() * columns), 0.0)};
    for (Index r = 0; r < part.rows; ++r) {
      for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) {
        for (Index c = 0; c < columns; ++c)
          part.weights[r * columns + c] += rows.weights[e] * ring.weights[rows.columns[e] * columns + c];
      }
    }
    const Placement at = placement.of(half<Net>(number));
    if (child.type != RingSteps::kPatch) {
      add_ring(steps, child.type, part, at, levels - 1);
      continue;
    }
    complete_net_patch<Net>(child.patch.rows.data(), part.weights.data(), columns);
    Matrix net{Net::kPoints, columns, Buffer<double>(static_cast<std::size_t>(Net::kPoints * columns), 0.0)};
    for (Index r = 0; r < Net::kPoints; ++r) {
      for (Index k = 0; k < Net::kSplinePoints; ++k) {
        const double weight = net_tables<Net>().from_spline[r][k];
        for (Index c = 0; c < columns; ++c) net.weights[r * columns + c] += weight * part.weights[k * columns + c];
      }
    }
    add_shape(at, RingSteps::kPatch, net);
  }
}

template <typename Net>
void net_of_spline(const Double4* spline, Double4* net) {
  const NetTables<Net>& tables = net_tables<Net>();
  for (int r = 0; r < Net::kPoints; ++r) {
    Double4 sum{};
    for (int k = 0; k < Net::kSplinePoints; ++k) sum += tables.from_spline[r][k] * spline[k];
    net[r] = sum;
  }
}

template <typename Net>
void ring_child_points(const RingSteps::Child& child, const Double4* ring, Double4* points) {
  const SparseRows& rows = child.rows;
  for (Index r = 0; r < rows.count(); ++r) {
    Double4 sum{};
    for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) sum += rows.weights[e] * ring[rows.columns[e]];
    points[r] = sum;
  }
  if (child.type == RingSteps::kPatch)
    complete_net_patch<Net>(child.patch.rows.data(), reinterpret_cast<double*>(points), 4);
}

template <typename Net>
SurfaceCells<Net>::SurfaceCells(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                const Progress& progress)
    : steps_(scheme) {
  constexpr double kCut = 0.3;
  constexpr double kChosen = 0.5;
  report_progress(progress, 0.0);
  if (needs_first_step(topology, scheme)) first_ = std::make_unique<Refinement>(topology, scheme);
  const Scheme after = scheme.after_first_step();
  pieces_ = std::make_unique<Pieces>(first_ == nullptr ? topology : first_->child(), after, kRingPieceLevels,
                                     Pieces::Rest::Rings);
  shapes_ = std::make_unique<CellShapes<Net>>(*pieces_, steps_);
  report_progress(progress, kCut);
  find_values(first_ == nullptr ? Values(control) : first_->apply(control));
  choose_cells(base_holes(topology, scheme), progress_within(progress, kCut, kChosen));
  build_tree(progress_within(progress, kChosen, 1.0));
}

/// As surface_holes has them; quad h of a first refinement lies in the face of corner h.
template <typename Net>
Buffer<std::uint8_t> SurfaceCells<Net>::base_holes(const Topology& topology, const Scheme& scheme) const {
  Buffer<std::uint8_t> holes = surface_holes(topology, scheme);
  if (first_ == nullptr || holes.empty()) return holes;
  Buffer<std::uint8_t> of_quads(static_cast<std::size_t>(base().face_count()));
  for (Index h = 0; h < base().face_count(); ++h) of_quads[h] = holes[topology.face(h)];
  return of_quads;
}

template <typename Net>
void SurfaceCells<Net>::find_values(ConstValuesRef base_values) {
  const LevelValues levels(*pieces_, base_values);
  for (int level = 0; level <= pieces_->region_count(); ++level) values_.push_back(vectors_of(levels.at(level)));
  limits_ = vectors_of(LimitMatrix(base(), pieces_->scheme()).apply(base_values));
  const Eigen::RowVector3d middle = 0.5 * (base_values.colwise().minCoeff() + base_values.colwise().maxCoeff());
  centre_ = Double4{middle[0], middle[1], middle[2], 0.0};
  const double size = (base_values.rowwise() - middle).cwiseAbs().maxCoeff();
  if (size > 0.0) scale_ = 1.0 / size;
  most_points_ = static_cast<std::size_t>(shapes_->most_points());
}

template <typename Net>
void SurfaceCells<Net>::gather(const Piece& piece, const Double4& origin, Double4* points) const {
  const bool patch = piece.kind == Piece::Kind::Patch;
  const Index count = patch ? Net::kSplinePoints : pieces_->shared_rings()[piece.shared_ring].topology.vertex_count();
  const Index* rows = pieces_->rows(piece);
  const Double4* values = values_[piece.level].data();
  bool complete = true;
  for (Index i = 0; i < count; ++i) {
    if (rows[i] == RegularPatch::kMissing) {
      complete = false;
    } else {
      points[i] = values[rows[i]] - origin;
    }
  }
  if (!complete) complete_net_patch<Net>(rows, reinterpret_cast<double*>(points), 4);
}

template <typename Net>
void SurfaceCells<Net>::points(const Cell& cell, const Double4& origin, Double4* scratch, Double4* points) const {
  gather(pieces_->begin(0)[cell.piece], origin, scratch);
  const CellShape& shape = shapes_->shape(cell.shape);
  const double* weights = shape.weights.data();
  for (Index r = 0; r < shape.rows; ++r, weights += shape.columns) {
    Double4 even{};
    Double4 odd{};
    Index k = 0;
    for (; k + 1 < shape.columns; k += 2) {
      even += weights[k] * scratch[k];
      odd += weights[k + 1] * scratch[k + 1];
    }
    if (k < shape.columns) even += weights[k] * scratch[k];
    points[r] = even + odd;
  }
}

template <typename Net>
Placement SurfaceCells<Net>::placement(const Cell& cell) const {
  const Piece& piece = pieces_->begin(0)[cell.piece];
  const double step = 1.0 / static_cast<double>(Index{1} << pieces_->levels());
  const Placement at{piece.x * step, piece.y * step, (piece.turned ? -step : step) * piece.size};
  return at.of(shapes_->shape(cell.shape).placement);
}

/// Each halves the bend.
template <typename Net>
int SurfaceCells<Net>::halvings(const Piece& piece, Double4* scratch) const {
  std::array<Double4, Net::kPoints> net;
  gather(piece, centre_, scratch);
  net_of_spline<Net>(scratch, net.data());
  double bend = NetFrame<Net>(net.data()).bend();
  int count = 0;
  for (; bend > kMostBend && count < CellShapes<Net>::kMostHalvings; bend *= 0.5) ++count;
  return count;
}

template <typename Net>
void SurfaceCells<Net>::choose_cells(const Buffer<std::uint8_t>& holes, const Progress& progress) {
  const Piece* pieces = pieces_->begin(0);
  const auto count = static_cast<Index>(pieces_->end(base().face_count() - 1) - pieces);
  Buffer<typename CellShapes<Net>::Range> ranges(static_cast<std::size_t>(count));
  parallel_for(
      count,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<Double4> scratch(most_points_);
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Piece& piece = pieces[i];
          if (!holes.empty() && holes[piece.face] != 0) {
            ranges[i] = {0, 0};
          } else if (piece.kind == Piece::Kind::Patch) {
            ranges[i] = shapes_->regular(halvings(piece, scratch.data()));
          } else {
            ranges[i] = shapes_->irregular(piece.shared_ring);
          }
        }
      },
      1024, progress);
  for (Index i = 0; i < count; ++i) {
    for (Index k = 0; k < ranges[i].count; ++k) cells_.push_back({i, ranges[i].first + k});
  }
}

/// Points whose hull has the cell in it, seen from the centre. A ring's hull is much larger than its face, so a few
/// halvings are made.
template <typename Net>
void SurfaceCells<Net>::gather_bounds(const Cell& cell, std::vector<Double4>& scratch,
                                      std::vector<Double4>& bounds) const {
  const CellShape& its_shape = shape(cell);
  bounds.resize(static_cast<std::size_t>(its_shape.rows));
  points(cell, centre_, scratch.data(), bounds.data());
  if (its_shape.kind == RingSteps::kPatch) return;
  std::vector<Double4> ring;
  ring.swap(bounds);
  add_ring_bounds(its_shape.kind, ring, kBoundLevels, bounds);
}

template <typename Net>
void SurfaceCells<Net>::add_ring_bounds(Index kind, std::vector<Double4>& ring, int levels,
                                        std::vector<Double4>& bounds) const {
  if (levels == 0) {
    bounds.insert(bounds.end(), ring.begin(), ring.end());
    return;
  }
  for (int number = 0; number < 4; ++number) {
    const RingSteps::Child& child = steps_.child(kind, number);
    std::vector<Double4> points(static_cast<std::size_t>(child.rows.count()));
    ring_child_points<Net>(child, ring.data(), points.data());
    if (child.type != RingSteps::kPatch) {
      add_ring_bounds(child.type, points, levels - 1, bounds);
      continue;
    }
    bounds.resize(bounds.size() + Net::kPoints);
    net_of_spline<Net>(points.data(), &bounds[bounds.size() - Net::kPoints]);
  }
}

template <typename Net>
void SurfaceCells<Net>::build_tree(const Progress& progress) {
  constexpr double kBoxes = 0.7;  // of the time
  Buffer<FloatBox> boxes(cells_.size());
  Buffer<LeaningBox> leaning(cells_.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(cells_.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<Double4> scratch(most_points_);
        std::vector<Double4> bounds;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          gather_bounds(cells_[i], scratch, bounds);
          for (Double4& point : bounds) point *= scale_;
          boxes[i] = box_of(bounds);
          const Double4 along = bounds[Net::kCorner[1]] - bounds[0];
          leaning[i] = leaning_box_of(reinterpret_cast<const Eigen::Vector4d*>(bounds.data()), bounds.size(),
                                      {along[0], along[1], along[2]});
        }
      },
      512, progress_within(progress, 0.0, kBoxes));
  report_progress(progress, kBoxes);
  Buffer<Index> order;
  tree_ = BoxTree(leaning, boxes, order);
  Buffer<Cell> sorted(cells_.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = cells_[order[i]];
  cells_ = std::move(sorted);
}

template class CellShapes<QuadNet>;
template class CellShapes<TriangleNet>;
template void ring_child_points<QuadNet>(const RingSteps::Child&, const Double4*, Double4*);
template void ring_child_points<TriangleNet>(const RingSteps::Child&, const Double4*, Double4*);
template void net_of_spline<QuadNet>(const Double4*, Double4*);
template void net_of_spline<TriangleNet>(const Double4*, Double4*);
template class SurfaceCells<QuadNet>;
template class SurfaceCells<TriangleNet>;

}  // namespace batten
