/// \file The control mesh that a fit starts from.
#pragma once
#include "batten/fit/fit_surface.h"

namespace batten {

/// Where the rounds start.
struct FitBeginning {
  Mesh mesh;
  bool settled = false;  ///< its surface is near the points: what is lost by a round is not given up for it
};

/// What a Loop mesh over the points is made of, and a sphere.
enum class LoopStart {
  Moved,  ///< a finer mesh, by moves (fit/loop_moves.h), where there are enough points; the sphere laid over the points
  Plain   ///< the first mesh, or the ellipsoid, as it is
};

/// The given mesh, a sphere, or a mesh over the points. cloud: with normals, without outliers; spacing: of the points.
/// Throws what first_mesh() throws.
FitBeginning find_beginning(const PointCloud& cloud, double spacing, const FitOptions& options, LoopStart loop,
                            const Progress& progress);

}  // namespace batten
