/// \file Normals of an adaptive mesh's corners, each on its own side of creases.
#pragma once
#include <functional>

#include "batten/adaptive/cell_faces.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// Outward; zero where the tangents are parallel.
Eigen::Vector3d unit_normal(const Jet& jet);

/// As Attribute has it.
struct CornerNormals {
  Values rows;                ///< the vertices', then those of corners that differ
  Buffer<Index> corner_rows;  ///< one a corner, or empty where none differs
};
/// The surface's unit normals at places, on the side of their faces.
using NormalsAt = std::function<Points(std::span<const SurfacePlace>)>;
/// vertex_normals: a row a vertex.
CornerNormals corner_normals(const NormalsAt& normals_at, const CellFaces& faces, const CellForest& forest,
                             const Points& vertex_normals);

}  // namespace batten
