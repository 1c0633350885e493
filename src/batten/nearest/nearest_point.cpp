#include "batten/nearest/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include "batten/error.h"
#include "batten/nearest/nearest_search.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/surface_patches.h"

namespace batten {

namespace {

constexpr double kTolerance = 1e-10;  ///< of the diagonal
/// From farther away, in diagonals, doubles no longer tell the surface's points apart.
constexpr double kFarthest = 1e8;

/// Moves bit i of a number to bit 3 i.
std::uint64_t spread_bits(std::uint64_t number) {
  constexpr int kBits = 10;
  std::uint64_t spread = 0;
  for (int bit = 0; bit < kBits; ++bit) spread |= (number >> bit & 1U) << (3 * bit);
  return spread;
}

/// The queries' rows in the order of a curve that fills the box around the surface: neighbours share the cache.
Buffer<std::uint64_t> rows_along_curve(ConstValuesRef queries, const Eigen::Vector3d& low, double size) {
  constexpr double kSteps = 1023.0;
  constexpr int kRowBits = 32;
  Buffer<std::uint64_t> rows(static_cast<std::size_t>(queries.rows()));
  parallel_for(queries.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      std::uint64_t code = 0;
      for (int c = 0; c < 3; ++c) {
        const double place = size > 0.0 ? (queries(i, c) - low[c]) / size : 0.0;
        code |= spread_bits(static_cast<std::uint64_t>(std::clamp(place, 0.0, 1.0) * kSteps)) << c;
      }
      rows[i] = code << kRowBits | static_cast<std::uint64_t>(i);
    }
  });
  std::sort(rows.begin(), rows.end());
  for (std::uint64_t& row : rows) row &= (std::uint64_t{1} << kRowBits) - 1;
  return rows;
}

Double4 vector_of(const Eigen::Vector3d& point) { return Double4{point[0], point[1], point[2], 0.0}; }

}  // namespace

struct NearestPoints::Parts {
  explicit Parts(const SurfacePatches& patches_in) : patches(patches_in) {}

  SurfacePatches patches;
  std::variant<std::monostate, SurfaceCells<QuadNet>, SurfaceCells<TriangleNet>> cells;
  Eigen::Vector3d centre;
  double diagonal = 0.0;
  double tolerance = 0.0;

  void measure();
  template <typename Net>
  NearestPoint find(NearestSearch<Net>& search, const Eigen::Vector3d& query) const;
};

/// For a query that is very far away, the search starts in the same direction at a distance that doubles can serve.
template <typename Net>
NearestPoint NearestPoints::Parts::find(NearestSearch<Net>& search, const Eigen::Vector3d& query) const {
  const Eigen::Vector3d away = query - centre;
  const double far = away.cwiseAbs().maxCoeff() < 1e100 ? away.norm() : away.stableNorm();
  const double farthest = std::max(kFarthest * diagonal, std::numeric_limits<double>::min());
  const bool too_far = far > farthest && diagonal > 0.0;
  const Eigen::Vector3d from = too_far ? Eigen::Vector3d(centre + away * (farthest / far)) : query;
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (from - centre).norm();
  // All boxes of a surface that is a point are equally near, and each of its points answers.
  const bool is_point = diagonal <= tolerance;
  const NearestFound found = search.find(vector_of(from), std::max(tolerance, rounding), is_point);
  NearestPoint result;
  const double most_u = std::is_same_v<Net, TriangleNet> ? 1.0 - found.v : 1.0;  // rounding on the third side
  result.place = {found.face, std::min(found.u, most_u), found.v};
  result.point = from + Eigen::Vector3d(found.offset[0], found.offset[1], found.offset[2]);
  result.distance = too_far ? (query - result.point).stableNorm() : std::sqrt(found.squared);
  result.least_distance = too_far || is_point ? std::max(result.distance - diagonal, 0.0) : std::sqrt(found.least);
  return result;
}

/// Takes the size of the surface from its boxes.
void NearestPoints::Parts::measure() {
  const auto run = [this](const auto& surface) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(surface)>, std::monostate>) {
      const Double4& middle = surface.centre();
      centre = {middle[0], middle[1], middle[2]};
      const FloatBox& box = surface.tree().bounds();
      const Eigen::Vector3d extent(box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]);
      diagonal = extent.norm() / surface.scale();
    }
  };
  std::visit(run, cells);
  const double size = centre.cwiseAbs().maxCoeff() + diagonal;
  tolerance = std::max(kTolerance * diagonal, 64.0 * std::numeric_limits<double>::epsilon() * size);
}

NearestPoints::NearestPoints(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress)
    : parts_(std::make_unique<Parts>(patches)) {
  require_control_points(patches.topology(), control);
  if (patches.topology().face_count() == 0)
    throw Error(ErrorCode::BadArgument, "there are no faces, so no surface to be near to");
  const auto build = [&](auto net) {
    using Net = decltype(net);
    const auto& cells = parts_->cells.emplace<SurfaceCells<Net>>(patches, control, progress);
    if (cells.cell_count() == 0)
      throw Error(ErrorCode::BadArgument, "all faces are holes, so there is no surface to be near to");
  };
  if (patches.quads()) {
    build(QuadNet());
  } else {
    build(TriangleNet());
  }
  parts_->measure();
}

NearestPoints::NearestPoints(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                             const Progress& progress)
    : NearestPoints(SurfacePatches(topology, scheme), control, progress) {}

void NearestPoints::set_control(ConstValuesRef control, const Progress& progress) {
  require_control_points(parts_->patches.topology(), control);
  const auto run = [&](auto& cells) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(cells)>, std::monostate>) cells.set_control(control, progress);
  };
  std::visit(run, parts_->cells);
  parts_->measure();
}

NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;

double NearestPoints::tolerance() const { return parts_->tolerance; }
double NearestPoints::diagonal() const { return parts_->diagonal; }

NearestPoint NearestPoints::nearest(const Eigen::Vector3d& query) const {
  NearestPoint found;
  nearest(Points(query.transpose()), {&found, 1});
  return found;
}

void NearestPoints::nearest(ConstValuesRef queries, std::span<NearestPoint> found, const Progress& progress) const {
  constexpr std::ptrdiff_t kBlock = 128;
  if (queries.cols() != 3)
    throw Error(ErrorCode::BadShape, "queries have three columns, not " + std::to_string(queries.cols()));
  if (static_cast<std::size_t>(queries.rows()) != found.size()) {
    throw Error(ErrorCode::BadShape, std::to_string(queries.rows()) + " queries have as many nearest points, not " +
                                         std::to_string(found.size()));
  }
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    if (!queries.row(i).allFinite())
      throw Error(ErrorCode::NotFinite, "row " + std::to_string(i) + " of the queries is not finite; leave it out");
  }
  const Eigen::Vector3d low = parts_->centre.array() - 0.5 * parts_->diagonal;
  const Buffer<std::uint64_t> rows = rows_along_curve(queries, low, parts_->diagonal);
  const auto run = [&](const auto& cells) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(cells)>, std::monostate>) {
      parallel_for(
          queries.rows(),
          [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
            NearestSearch search(cells);
            for (std::ptrdiff_t i = begin; i < end; ++i)
              found[rows[i]] = parts_->find(search, queries.row(static_cast<Eigen::Index>(rows[i])).transpose());
          },
          kBlock, progress);
    }
  };
  std::visit(run, parts_->cells);
}

}  // namespace batten
