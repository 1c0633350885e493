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
#include "batten/progress.h"
#include "batten/surface/face_jets.h"

namespace batten {

namespace {

JetRow row_of(JetPart part) {
  constexpr JetRow kRows[] = {JetRow::Value, JetRow::Du, JetRow::Dv, JetRow::Duu, JetRow::Duv, JetRow::Dvv};
  return kRows[static_cast<int>(part)];
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
  VertexWeights patch_row(const RegularPatch& patch, const Eigen::RowVectorXd& weights) const;
  VertexWeights vertex_row(const SurfacePlace& place, JetPart part) const;
};

/// What is missing of the patch follows from the rest by reflection.
VertexWeights SurfaceWeights::Parts::patch_row(const RegularPatch& patch, const Eigen::RowVectorXd& weights) const {
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

PlaceRows SurfaceWeights::Parts::make_rows(const SurfacePlace& place, std::span<const JetPart> parts,
                                           FaceRing& scratch) const {
  PlaceRows rows;
  FaceJet jet;
  const Index type = faces.type(place.face);
  std::vector<JetRow> jet_rows;
  for (const JetPart part : parts) jet_rows.push_back(row_of(part));
  if (!face_jet(quads(), faces.ring_types(), type, place.u, place.v, jet_rows, jet)) {
    for (const JetPart part : parts) rows.push_back(vertex_row(place, part));
    return rows;
  }
  if (type == RingTypes::kPatch) {
    const RegularPatch patch = faces.patch(place.face);
    for (Eigen::Index r = 0; r < jet.rows(); ++r) rows.push_back(patch_row(patch, jet.row(r)));
    return rows;
  }
  const std::span<const Index> ring = faces.ring(place.face, scratch);
  for (Eigen::Index r = 0; r < jet.rows(); ++r) {
    VertexWeights& row = rows.emplace_back();
    for (std::size_t i = 0; i < ring.size(); ++i) row.emplace_back(ring[i], jet(r, static_cast<Eigen::Index>(i)));
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
