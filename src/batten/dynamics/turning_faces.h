/// \file The rest shape of an elastic surface, face by face, as it turns with the faces.
///
/// With the matrix K_f of a face, its points p at rest r (n-by-3 each), the energy 1/2 |p - r R^T|^2 in K_f is least
/// for the rotation R that makes trace(R^T A) greatest, A = p^T K_f r. The face then adds K_f r R^T to the force. So
/// the gradients g = K_f r are all that is needed of K_f: A = p^T g, and the force g R^T.
#pragma once
#include <Eigen/Core>

#include "batten/buffer.h"
#include "batten/energy/shape_energy.h"
#include "batten/energy/surface_energy.h"
#include "batten/types.h"

namespace batten {

/// Const and safe from several threads. Memory: some 900 bytes a face.
class TurningFaces {
 public:
  TurningFaces() = default;

  /// Adds elements with gradients g (element_gradients()), by vertices of the base; rest: the base's points. Elements
  /// of the same number turn together.
  void add(const FaceElements& elements, const Buffer<double>& gradients, const Points& rest);
  /// After the last.
  void finish(Index vertex_count);

  /// Sum of 1/2 r^T K_f r over the faces.
  double rest_energy() const { return rest_energy_; }

  /// The sum over the faces of trace(R^T A) for their best rotations, for points of the base. result: the sum of K_f r
  /// R^T, unless it is null; resized.
  double turn(const Points& points, Points* result) const;

 private:
  struct Part {
    Index vertex;
    Eigen::RowVector3d gradient;
  };
  struct Use {
    Index element;
    Eigen::RowVector3d gradient;
  };

  Buffer<std::size_t> starts_{0};  ///< of each element's parts
  Buffer<Part> parts_;
  Buffer<std::size_t> first_uses_;  ///< of each vertex
  Buffer<Use> uses_;
  double rest_energy_ = 0.0;
};

}  // namespace batten
