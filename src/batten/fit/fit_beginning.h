/// \file The control mesh that a fit starts from.
#pragma once
#include "batten/fit/fit_surface.h"
#include "batten/fit/outliers.h"

namespace batten {

/// Where the rounds start.
struct FitBeginning {
  Mesh mesh;
  bool settled = false;  ///< its surface is near the points: what is lost by a round is not given up for it
};

/// The given mesh, a sphere, a mesh over the points, or for Loop one that moves have made of a finer one
/// (fit/loop_moves.h). cloud: with normals; filter: of the same points. Throws what first_mesh() throws.
FitBeginning find_beginning(const PointCloud& cloud, const OutlierFilter& filter, const FitOptions& options,
                            const Progress& progress);

}  // namespace batten
