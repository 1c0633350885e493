/// \file What makes a new mesh from a mesh or from points.
#pragma once
#include <memory>

#include "studio/engine/mesh_file.h"

namespace batten::studio {

/// wishes: {scheme, boundary}; here and below. {points, removed}.
val denoised_points(const std::shared_ptr<MeshFile>& file, const val& wishes, int m, int passes, const val& report);
/// gains: finest bumps first. {points, labels: [[shortest, longest]]}.
val banded_points(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& gains);
/// Between two meshes of the same faces: {points} at time t in [0, 1].
val morphed_points(const std::shared_ptr<MeshFile>& from, const std::shared_ptr<MeshFile>& to, const val& wishes,
                   double t);
/// Iterations of ours and the papers': [{name, failure, residuals, measuredAfter, iterations, seconds, maxError}].
val compared_methods(const std::shared_ptr<MeshFile>& file, const val& wishes, const val& report);
/// A surface to points: {mesh, rms, max, outliers, rounds: [{vertices, rms, max}]}. When the report says stop after a
/// round, what is there is given.
val fitted(const std::shared_ptr<MeshFile>& points, int vertices, double tolerance, const val& report);

}  // namespace batten::studio
