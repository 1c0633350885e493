/// \file How large a segmented surface is and how well it sits.
#pragma once
#include <cstdint>

#include "batten/mesh/topology.h"
#include "batten/nearest/distance_summary.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"
#include "batten/volume/volume.h"

namespace batten {

/// What measure_surface() refines to.
inline constexpr std::int64_t kMeasuredFaces = 60000;

/// A closed surface as a fine mesh, and what it holds.
struct SurfaceMeasures {
  Mesh fine;                            ///< of the limit surface
  double volume = 0.0;                  ///< mm^3
  double area = 0.0;                    ///< mm^2
  std::int64_t self_intersections = 0;  ///< pairs of triangles of the fine mesh
};

/// The limit surface as a mesh, refined once or more, until it has so many faces. Throws what surface_mesh() throws.
Mesh surface_of_faces(const Topology& topology, const Scheme& scheme, const Mesh& control, std::int64_t least);

/// control: the mesh of the topology. Refines so far that the volume is exact to about 1e-5. Throws what surface_mesh()
/// throws; Cancelled.
SurfaceMeasures measure_surface(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                const Progress& progress = {});

/// How a surface agrees with a mask.
struct MaskAgreement {
  double dice = 0.0;           ///< of the voxels whose centres are inside
  double mask_volume = 0.0;    ///< mm^3
  DistanceSummary to_surface;  ///< from mask_border()'s points to the surface, mm
  DistanceSummary to_border;   ///< from places of the surface to the plane of the nearest of them, mm
};

/// fine: as measure_surface() gives. mask: as label_mask() gives.
MaskAgreement compare_with_mask(const Mesh& fine, const Volume& mask);

/// How strong the image's edges are under a surface.
struct EdgeStrength {
  double mean = 0.0;  ///< |derivative along the normal| of the smoothed image under the surface, per mm
  double best = 0.0;  ///< the same, each place at its best within two voxels along the normal
  double share() const { return best > 0.0 ? mean / best : 0.0; }
};

/// alpha: of the smoothing, 1/mm (volume/recursive_filter.h).
EdgeStrength edge_strength(const Mesh& fine, const Volume& image, double alpha);

}  // namespace batten
