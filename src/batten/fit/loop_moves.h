/// \file The connectivity of a Loop surface, improved by local moves.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/progress.h"

namespace batten {

/// Options of improve_loop_mesh().
struct LoopMoveOptions {
  Index vertices = 400;   ///< at most so many control points
  bool creases = true;    ///< edges may become sharp, or smooth
  int sweeps = 3;         ///< at most so many rounds of moves
  double spacing = 0.0;   ///< of the points: lines of sharp edges of less than eight are left out in the end
  double fairness = 1.0;  ///< what bends of the control mesh count beside the squared distances that are left
};

/// Makes the sum of squared distances from the points to the Loop surface of a mesh smaller by moves of single control
/// points, and by edges that collapse, split, turn, and become sharp or smooth, after Hoppe and others (1993, 1994,
/// keys HDDMS93, HDDH94). Other than there each move is tried with steps of tangent distance, all candidates at once on
/// the same surface, and made in the order of their gains, each tried anew before. What a control point costs follows
/// from the budget: where there are as many as allowed, edges split that gain more than the collapses cost that make
/// room. mesh: triangles that Topology accepts, with creases; points: without outliers. The result depends on the input
/// alone. Throws Error: what Topology throws, Cancelled.
Mesh improve_loop_mesh(const Mesh& mesh, const Points& points, const LoopMoveOptions& options,
                       const Progress& progress = {});

}  // namespace batten
