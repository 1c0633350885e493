/// \file Which cells of a forest a chord tolerance splits.
#pragma once
#include "batten/adaptive/cell_forest.h"
#include "batten/adaptive/cell_nets.h"
#include "batten/surface/limit_surface.h"

namespace batten {

struct ChordRule {
  double tolerance;
  bool quartered;  ///< true if leaves are cut into quads once more
  int max_level;
  Index max_leaves;
};

/// Splits the cells of a forest that has only its roots. Returns the cells of max_level that are beyond the tolerance.
/// points: a row for each vertex of the forest. Throws Error(TooLarge).
Buffer<Index> cut_by_chord(const CellNets& nets, const LimitSurface& surface, const Points& points,
                           const ChordRule& rule, CellForest& forest, const Progress& progress = {});

/// True if no root is beyond the tolerance.
bool roots_suffice(const CellNets& nets, const LimitSurface& surface, const Points& points, double tolerance,
                   const CellForest& forest);

}  // namespace batten
