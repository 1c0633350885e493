/// \file Derivatives at places of a face as rows of weights, once for all faces with the same surroundings.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "batten/energy/face_elements.h"
#include "batten/surface/face_jets.h"
#include "batten/surface/quadrature.h"

namespace batten {

/// The places of a kind of face.
struct JetTable {
  Buffer<Index> points;              ///< places in the face's ring or, of a regular face, in its patch
  std::vector<SurfacePlace> places;  ///< their faces say nothing
  std::vector<double> weights;       ///< of du dv, one a place
  /// A row for each JetRow that was asked for, place by place, by `points`.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jets;
};

/// That of a kind of the elements at the given places of a face, none of which is a vertex. rows: of each place.
JetTable jet_table(const SurfacePatches& patches, const FaceElements& elements, Index kind,
                   std::span<const JetRow> rows, const SurfaceQuadrature& quadrature);

/// One a kind of the elements, at the places of face_quadrature(). Throws as that.
std::vector<JetTable> jet_tables(const SurfacePatches& patches, const FaceElements& elements,
                                 std::span<const JetRow> rows, const QuadratureOptions& options);

}  // namespace batten
