/// \file Normals at an adaptive mesh's corners, each on its own side of creases.
#pragma once
#include <functional>

#include "batten/adaptive/cell_faces.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// The outward unit normal; zero where the tangents are parallel.
Eigen::Vector3d unit_normal(const Jet& jet);

/// Normals in the form of an Attribute.
struct CornerNormals {
  Values rows;                ///< one for each vertex, then those of corners that differ
  Buffer<Index> corner_rows;  ///< one for each corner, or empty if no corner differs
};
/// Computes the surface's unit normals at places, on the side of their faces.
using NormalsAt = std::function<Points(std::span<const SurfacePlace>)>;
/// vertex_normals: a row for each vertex.
CornerNormals corner_normals(const NormalsAt& normals_at, const CellFaces& faces, const CellForest& forest,
                             const Points& vertex_normals);

}  // namespace batten
