/// \file The components of a mesh and how each of them meets its targets.
#pragma once
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// One component's targets and errors.
struct ComponentErrors {
  ValueRow centre;        ///< of the targets' bounding box
  double diagonal = 0.0;  ///< of the targets' bounding box
  double largest = 0.0;   ///< the largest absolute value of a target
  double error = 0.0;     ///< the largest of a row, or NaN
  double farthest = 0.0;  ///< the longest row of the control points: what their rounding grows with
  double movement = 0.0;  ///< the farthest that a control point lies from its target, or NaN

  /// Within the tolerance, which is relative to the diagonal, or within rounding of it.
  bool is_reached(double tolerance) const;
  /// Not farther off than double coordinates as far from the origin as these can be helped to be.
  bool is_rounding() const;
  /// Small beside the control points, though it may be more than rounding: the system is not singular.
  bool is_near() const;
  /// Control points of a system with a solution stay within some hundred diagonals of their targets. Where they have
  /// gone farther, the system was singular, and what they hold is rounding.
  bool is_diverged() const;
};

/// One entry a component. errors: one entry a vertex; control and targets: a row a vertex. O(V k).
std::vector<ComponentErrors> component_errors(const Components& components, const Buffer<double>& errors,
                                              ConstValuesRef control, ConstValuesRef targets);

/// Coordinates in which a component lies at the origin and has a diagonal in [1/2, 1); the scale is a power of 2.
class OwnCoordinates {
 public:
  explicit OwnCoordinates(const ComponentErrors& component);
  ValueRow inwards(const ValueRow& row) const { return (row - centre_) * scale_; }
  ValueRow outwards(const ValueRow& row) const { return row / scale_ + centre_; }
  /// The diagonal in these coordinates is at least this, but for a component without any extent.
  static constexpr double kLeastDiagonal = 0.5;

 private:
  ValueRow centre_;
  double scale_ = 1.0;
};

}  // namespace batten
