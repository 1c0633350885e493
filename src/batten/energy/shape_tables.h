/// \file The jets at a face's quadrature places, once for all faces with the same surroundings.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "batten/energy/face_elements.h"
#include "batten/energy/shape_energy_kind.h"
#include "batten/surface/quadrature.h"

namespace batten {

/// The places of a kind of face.
struct ShapeTable {
  Buffer<Index> points;         ///< places in the face's ring or, of a regular face, in its patch
  std::vector<double> weights;  ///< of du dv, one a place
  /// The rows of shape_jet_rows(), place by place, by `points`.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jets;
};

/// One a kind of the elements.
std::vector<ShapeTable> shape_tables(const SurfacePatches& patches, const FaceElements& elements, ShapeEnergyKind kind,
                                     const QuadratureOptions& options);

}  // namespace batten
