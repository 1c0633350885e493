/// \file The surface as few triangles as a tolerance allows, as the page draws it.
#pragma once
#include <cstdint>
#include <vector>

#include "batten/adaptive/adaptive.h"
#include "batten/expand/surface_fields.h"

namespace batten::studio {

/// Rows of three floats for each vertex drawn, the control mesh's first; the sides of a sharp crease are drawn apart.
struct AdaptiveDrawing {
  AdaptiveMesh adaptive;
  std::vector<std::uint32_t> triangles;
  std::vector<float> points;
  std::vector<float> normals;
};

/// chord: AdaptiveOptions::chord. Throws what tessellate_adaptively() throws.
AdaptiveDrawing draw_adaptively(const SurfacePatches& patches, const Values& control, double chord);

/// A number for each vertex drawn, as surface_field() has them. drawing: of the surface as it is.
Scalars adaptive_field(const FieldSurface& surface, SurfaceField field, const AdaptiveDrawing& drawing, double chord);

}  // namespace batten::studio
