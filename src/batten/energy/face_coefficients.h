/// \file Coefficients of energies and materials: one for all faces, or one a face of the control mesh.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/types.h"

namespace batten {

/// Throws Error(BadShape) unless there is one, or one a face; Error(NotFinite), Error(BadArgument) naming the face
/// whose coefficient is not finite or negative. name: as in "density".
void require_coefficients(std::span<const double> coefficients, Index face_count, const std::string& name);

inline double coefficient_of(std::span<const double> coefficients, Index face) {
  return coefficients[coefficients.size() == 1 ? 0 : static_cast<std::size_t>(face)];
}

/// The same for the child of a Refinement of `parent`: each face has that of the face which it lies in. quads: refined
/// by Catmull-Clark, else by four triangles a face.
std::vector<double> child_coefficients(std::span<const double> coefficients, const Topology& parent, bool quads);

}  // namespace batten
