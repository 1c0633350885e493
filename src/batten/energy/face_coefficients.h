/// \file Coefficients of energies and materials: one for all faces, or one a face of the control mesh.
#pragma once
#include <string>
#include <vector>

#include "batten/types.h"

namespace batten {

/// Throws Error(BadShape) unless there is one, or one a face; Error(NotFinite), Error(BadArgument) naming the face
/// whose coefficient is not finite or negative. name: as in "density".
void require_coefficients(const std::vector<double>& coefficients, Index face_count, const std::string& name);

inline double coefficient_of(const std::vector<double>& coefficients, Index face) {
  return coefficients[coefficients.size() == 1 ? 0 : static_cast<std::size_t>(face)];
}

}  // namespace batten
