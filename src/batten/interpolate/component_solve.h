/// \file One component of the mesh, solved by itself.
#pragma once
#include "batten/interpolate/component_errors.h"
#include "batten/interpolate/value_set.h"

namespace batten {

/// A component in its own coordinates; the rows of all others are zero. O(V k) memory.
class ComponentSolve {
 public:
  /// vertices: of the component, ascending. Starts from the targets; known vertices hold what they have in `set`.
  ComponentSolve(const InterpolationSystem& system, const ValueSet& set, const Buffer<Index>& vertices);

  /// Puts the control points into `set`, unless that cannot be done: then false, and the start is as it was.
  bool solve(const LimitMatrix& matrix, ValueSet& set);

  /// The control points that miss the targets by the least, into `set`, and its aims.
  void miss_least(ValueSet& set);

 private:
  void put_back(ValueSet& set) const;

  const InterpolationSystem& system_;
  const Buffer<Index>& vertices_;
  OwnCoordinates coordinates_;
  Buffer<std::uint8_t> unknown_;
  Values targets_;
  Values x_;
};

/// When to stop in own coordinates.
StopRule own_stop_rule(const InterpolationSystem& system, const ValueSet& set);

}  // namespace batten
