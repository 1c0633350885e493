#include "batten/energy/jet_tables.h"

#include "batten/parallel/parallel.h"
#include "batten/patch/face_types.h"

namespace batten {

namespace {

/// The columns of points that have a say: what lies beyond a sharp crease has none.
Buffer<Index> used_columns(const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::Stride<-1, -1>>& jets) {
  Buffer<Index> used;
  for (Eigen::Index c = 0; c < jets.cols(); ++c) {
    if (!jets.col(c).isZero(0.0)) used.push_back(static_cast<Index>(c));
  }
  return used;
}

}  // namespace

JetTable jet_table(const SurfacePatches& patches, const FaceElements& elements, Index kind,
                   std::span<const JetRow> rows, const SurfaceQuadrature& quadrature) {
  const RingTypes& types = patches.face_types().ring_types();
  const bool is_ring = elements.is_ring(kind);
  const Index type = is_ring ? kind : RingTypes::kPatch;
  const auto count = static_cast<Eigen::Index>(rows.size());
  const auto places = static_cast<Eigen::Index>(quadrature.places.size());
  const Eigen::MatrixXd by_distinct =
      is_ring ? Eigen::MatrixXd() : layout_points(patches.quads(), elements.layout(kind));
  JetTable table;
  table.places = quadrature.places;
  table.weights = quadrature.weights;
  Eigen::MatrixXd jets;
  FaceJet jet;
  for (Eigen::Index p = 0; p < places; ++p) {
    const SurfacePlace& place = quadrature.places[static_cast<std::size_t>(p)];
    face_jet(patches.quads(), types, type, place.u, place.v, rows, jet);
    if (!is_ring) jet = (jet * by_distinct).eval();
    if (p == 0) jets.resize(count * places, jet.cols());
    jets.middleRows(p * count, count) = jet;
  }
  if (!is_ring) {
    table.points = distinct_points(patches.quads(), elements.layout(kind));
    table.jets = jets;
    return table;
  }
  table.points = used_columns(jets);
  table.jets.resize(jets.rows(), static_cast<Eigen::Index>(table.points.size()));
  for (Eigen::Index c = 0; c < table.jets.cols(); ++c) table.jets.col(c) = jets.col(table.points[c]);
  return table;
}

std::vector<JetTable> jet_tables(const SurfacePatches& patches, const FaceElements& elements,
                                 std::span<const JetRow> rows, const QuadratureOptions& options) {
  std::vector<JetTable> tables(static_cast<std::size_t>(elements.kind_count()));
  parallel_for_each(elements.kind_count(), [&](std::ptrdiff_t k) {
    const auto kind = static_cast<Index>(k);
    const Index type = elements.is_ring(kind) ? kind : RingTypes::kPatch;
    const SurfaceQuadrature quadrature =
        face_quadrature(patches.quads(), patches.face_types().ring_types(), type, options);
    tables[static_cast<std::size_t>(k)] = jet_table(patches, elements, kind, rows, quadrature);
  });
  return tables;
}

}  // namespace batten
