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

/// Const and safe from several threads. Memory: some 600 bytes a face.
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
  /// A vertex of an element, and its gradient.
  struct Parts {
    Buffer<Index> vertices;
    Buffer<double> gradients;  ///< three numbers each

    std::size_t size() const { return vertices.size(); }
    void reserve(std::size_t count);
    void add(Index vertex, const Eigen::RowVector3d& gradient);
    Eigen::Map<Eigen::RowVector3d> gradient(std::size_t i) {
      return Eigen::Map<Eigen::RowVector3d>(gradients.data() + 3 * i);
    }
    Eigen::Map<const Eigen::RowVector3d> gradient(std::size_t i) const {
      return Eigen::Map<const Eigen::RowVector3d>(gradients.data() + 3 * i);
    }
  };
  struct Use {
    Index element;
    Index part;
  };

  Buffer<std::size_t> starts_{0};  ///< of each element's parts
  Parts parts_;
  Buffer<std::size_t> first_uses_;  ///< of each vertex
  Buffer<Use> uses_;
  double rest_energy_ = 0.0;
};

}  // namespace batten
