/// \file A coarse control mesh of the right genus over a cloud of points, to start a fit from.
#pragma once
#include <optional>
#include <vector>

#include "batten/fit/point_cloud.h"
#include "batten/mesh/face_kind.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// How quads are laid.
enum class QuadPattern {
  Adapted,  ///< smaller where the surface bends: the triangles of FaceKind::Triangles joined in pairs
  Grid      ///< of equal size along a grid, regular where the surface follows the axes; Adapted where that would have
            ///< another topology
};

/// Where the first mesh has creases.
enum class CreaseSearch {
  None,  ///< it is smooth
  Auto   ///< along the sharp edges of the data, on which its edges then lie (fit/sharp_edges.h)
};

/// Options of first_mesh(). Lengths are in the unit of the points.
struct FirstMeshOptions {
  FaceKind faces = FaceKind::Quads;
  QuadPattern pattern = QuadPattern::Adapted;
  CreaseSearch creases = CreaseSearch::None;  ///< not with QuadPattern::Grid
  Index vertices = 400;                       ///< about so many; 8 to 1,000,000
  std::optional<Index> genus;                 ///< of all components together: no other is taken
  /// Gaps between points up to this width are closed, wider ones become boundaries. Without: gaps are closed where they
  /// are less than a fifth of the box's longest side wide.
  std::optional<double> bridge;
};

/// What a component of a first mesh looks like.
struct FirstMeshPart {
  Index vertices = 0;
  Index genus = 0;
  Index boundary_loops = 0;
};

/// The mesh and how it was found.
struct FirstMesh {
  Mesh mesh;                         ///< accepted by Topology; vertices near the points
  std::vector<FirstMeshPart> parts;  ///< the components, ordered by lowest vertex
  double spacing = 0.0;              ///< of the grid that the mesh was cut from
  double point_spacing = 0.0;        ///< the median distance of neighbouring points
  Index repeated_points = 0;         ///< points at the place of another
  Index outliers = 0;                ///< points left out
  Index dropped_parts = 0;           ///< pieces of the contour with few points beside them

  Index genus() const;  ///< of all components together
};

/// The result depends on the points, not on their order. Throws Error: BadShape, NotFinite, BadArgument (fewer than 20
/// points apart, all on a line; an option out of its range), NotConverged (the genus asked for does not come out),
/// Cancelled.
FirstMesh first_mesh(const PointCloud& cloud, const FirstMeshOptions& options = {}, const Progress& progress = {});

}  // namespace batten
