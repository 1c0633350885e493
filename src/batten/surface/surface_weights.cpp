#include "batten/surface/surface_weights.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/limit/vertex_limit.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/face_types.h"
#include "batten/patch/halving.h"
#include "batten/patch/spline_jet.h"
#include "batten/progress.h"

namespace batten {

namespace {

/// Derivatives' weights deep down are large, and shrink on their way up only as far as they sum to zero: without this,
/// rounding would not shrink with them.
void keep_sum_zero(std::vector<double>& weights) { weights[0] -= std::accumulate(weights.begin(), weights.end(), 0.0); }

const std::array<double, 16>& part_of(const JetWeights& weights, JetPart part) {
  switch (part) {
    case JetPart::Point:
      return weights.value;
    case JetPart::Du:
      return weights.du;
    case JetPart::Dv:
      return weights.dv;
    case JetPart::Duu:
      return weights.duu;
    case JetPart::Duv:
      return weights.duv;
    default:
      return weights.dvv;
  }
}

/// Derivatives by parameters that run `scale` times as fast.
double chain_factor(JetPart part, double scale) {
  if (part == JetPart::Point) return 1.0;
  return part == JetPart::Du || part == JetPart::Dv ? scale : scale * scale;
}

/// Weights of the points of a ring's child as weights of the ring's points.
std::vector<double> to_ring(const RingTypes::Step& step, const Buffer<Index>& child,
                            const std::vector<double>& weights) {
  std::vector<double> of_ring(static_cast<std::size_t>(step.ring_size), 0.0);
  for (std::size_t p = 0; p < child.size(); ++p) {
    for (Index e = step.rows.starts[child[p]]; e < step.rows.starts[child[p] + 1]; ++e) {
      of_ring[step.rows.columns[e]] += weights[p] * step.rows.weights[e];
    }
  }
  return of_ring;
}

}  // namespace

/// The rows of a place, one a part.
using PlaceRows = std::vector<VertexWeights>;

struct SurfaceWeights::Parts {
  SurfacePatches patches;
  const FaceTypes& faces;

  explicit Parts(const SurfacePatches& patches_in) : patches(patches_in), faces(patches.face_types()) {}

  bool quads() const { return patches.quads(); }
  PlaceRows make_rows(const SurfacePlace& place, std::span<const JetPart> parts, FaceRing& scratch) const;
  VertexWeights patch_row(const RegularPatch& patch, const std::array<double, 16>& weights) const;
  VertexWeights vertex_row(const SurfacePlace& place, JetPart part) const;
};

/// What is missing of the patch follows from the rest by reflection.
VertexWeights SurfaceWeights::Parts::patch_row(const RegularPatch& patch, const std::array<double, 16>& weights) const {
  VertexWeights row;
  const int count = patches.patch_size();
  const auto* const end = patch.rows.data() + count;
  if (std::find(static_cast<const Index*>(patch.rows.data()), end, RegularPatch::kMissing) == end) {
    for (int i = 0; i < count; ++i) row.emplace_back(patch.rows[i], weights[i]);
    return row;
  }
  Values points = Values::Identity(count, count);
  complete_patch(quads(), patch.rows.data(), points.data(), count);
  for (int j = 0; j < count; ++j) {
    if (patch.rows[j] == RegularPatch::kMissing) continue;
    double weight = 0.0;
    for (int i = 0; i < count; ++i) weight += weights[i] * points(i, j);
    row.emplace_back(patch.rows[j], weight);
  }
  return row;
}

/// At an extraordinary vertex itself.
VertexWeights SurfaceWeights::Parts::vertex_row(const SurfacePlace& place, JetPart part) const {
  VertexWeights row;
  if (part == JetPart::Duu || part == JetPart::Duv || part == JetPart::Dvv) return row;
  const Index corner = nearest_corner(quads(), place.u, place.v);
  const TileValue value = part == JetPart::Point ? TileValue::Limit
                          : part == JetPart::Du  ? TileValue::TangentU
                                                 : TileValue::TangentV;
  visit_vertex_limit(patches.base(), patches.base_scheme(), value, patches.base().face_begin(place.face) + corner,
                     [&](Index vertex, double weight) { row.emplace_back(vertex, weight); });
  return row;
}

/// Down to the patch that the place lies in, then each part's weights back up to the ring of the face.
PlaceRows SurfaceWeights::Parts::make_rows(const SurfacePlace& place, std::span<const JetPart> parts,
                                           FaceRing& scratch) const {
  PlaceRows rows;
  JetWeights jet;
  const RingTypes& types = faces.ring_types();
  double u = place.u;
  double v = place.v;
  double scale = 1.0;
  std::vector<std::pair<Index, int>> path;
  Index type = faces.type(place.face);
  const bool regular = type == RingTypes::kPatch;
  while (type != RingTypes::kPatch && path.size() < kHalvingsToVertex) {
    const Halving step = halve(quads(), u, v);
    scale *= step.factor;
    path.emplace_back(type, step.child);
    type = types.child(type, step.child).type;
  }
  if (type != RingTypes::kPatch) {
    for (const JetPart part : parts) rows.push_back(vertex_row(place, part));
    return rows;
  }
  jet_weights(quads(), u, v, jet);
  if (regular) {
    const RegularPatch patch = faces.patch(place.face);
    for (const JetPart part : parts) rows.push_back(patch_row(patch, part_of(jet, part)));
    return rows;
  }
  const std::span<const Index> ring = faces.ring(place.face, scratch);
  for (const JetPart part : parts) {
    const auto& patch = part_of(jet, part);
    std::vector<double> weights(patch.begin(), patch.begin() + patches.patch_size());
    for (double& weight : weights) weight *= chain_factor(part, scale);
    if (part != JetPart::Point) keep_sum_zero(weights);
    for (std::size_t i = path.size(); i-- > 0;) {
      const RingTypes::Step& step = types.step(path[i].first);
      weights = to_ring(step, step.children[path[i].second], weights);
      if (part != JetPart::Point) keep_sum_zero(weights);
    }
    VertexWeights& row = rows.emplace_back();
    for (std::size_t i = 0; i < weights.size(); ++i) row.emplace_back(ring[i], weights[i]);
  }
  return rows;
}

SurfaceWeights::SurfaceWeights(const SurfacePatches& patches) : parts_(std::make_unique<Parts>(patches)) {}

SurfaceWeights::SurfaceWeights(const Topology& topology, const Scheme& scheme, const Progress& progress)
    : SurfaceWeights(SurfacePatches(topology, scheme, progress_within(progress, 0.0, 0.5))) {
  report_progress(progress, 1.0);
}

SurfaceWeights::~SurfaceWeights() = default;
SurfaceWeights::SurfaceWeights(SurfaceWeights&&) noexcept = default;

const SurfacePatches& SurfaceWeights::patches() const { return parts_->patches; }

namespace {

/// Row i of the matrix is rows[i][part].
SurfaceWeights::Matrix matrix_of(const std::vector<PlaceRows>& rows, std::size_t part, Index columns) {
  std::size_t entries = 0;
  for (const PlaceRows& of_place : rows) entries += of_place[part].size();
  if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::TooLarge, std::to_string(rows.size()) + " places have " + std::to_string(entries) +
                                         " weights, more than 2^31 - 1; ask for fewer at a time");
  }
  SurfaceWeights::Matrix matrix(static_cast<Eigen::Index>(rows.size()), columns);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    matrix.outerIndexPtr()[i] = next;
    for (const auto& [column, weight] : rows[i][part]) {
      matrix.innerIndexPtr()[next] = column;
      matrix.valuePtr()[next++] = weight;
    }
  }
  matrix.outerIndexPtr()[rows.size()] = next;
  return matrix;
}

}  // namespace

std::vector<SurfaceWeights::Matrix> SurfaceWeights::rows(std::span<const SurfacePlace> places,
                                                         std::span<const JetPart> parts,
                                                         const Progress& progress) const {
  for (const SurfacePlace& place : places) require_place(base(), place);
  std::vector<PlaceRows> rows(places.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(places.size()),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        FaceRing scratch;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          rows[i] = parts_->make_rows(places[i], parts, scratch);
          for (VertexWeights& row : rows[i]) {
            row = patches().by_control(std::move(row));
            row.erase(std::remove_if(row.begin(), row.end(), [](const auto& entry) { return entry.second == 0.0; }),
                      row.end());
          }
        }
      },
      256, progress);
  std::vector<Matrix> matrices;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    matrices.push_back(matrix_of(rows, p, patches().topology().vertex_count()));
  }
  return matrices;
}

SurfaceWeights::Matrix SurfaceWeights::rows(std::span<const SurfacePlace> places, JetPart part,
                                            const Progress& progress) const {
  Matrix matrix;
  matrix.swap(rows(places, std::span(&part, 1), progress).front());
  return matrix;
}

}  // namespace batten
