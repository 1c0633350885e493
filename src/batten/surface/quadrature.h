/// \file Integrals over the limit surface as weighted sums over places.
#pragma once
#include <vector>

#include "batten/surface/limit_surface.h"

namespace batten {

class RingTypes;

/// How exact a quadrature is.
struct QuadratureOptions {
  /// Gauss points along each side of a cell: on regular faces polynomials of degree 2 points - 1 in u and in v (on
  /// triangles of degree 2 points - 2 in both) are integrated exactly. 1 to 16.
  int points = 4;
  /// Faces beside irregular vertices are halved so often towards them; what is left has points of its own. The jets
  /// there are bounded, so the error of a bounded integrand falls by four a level. 0 to 40.
  int levels = 6;
};

/// A place and what it counts.
struct SurfaceQuadrature {
  std::vector<SurfacePlace> places;  ///< inside faces of the base, face by face; those of holes are left out
  std::vector<double> weights;       ///< of du dv: they sum to 1 on a quad, to 1/2 on a triangle
  std::vector<std::size_t> starts;   ///< F + 1: where the places of each face of the base begin
};

/// O(places): points^2 on a regular face, some 3 levels as many beside an irregular vertex. Throws Error(BadArgument)
/// for the Butterflies and for options out of range.
SurfaceQuadrature surface_quadrature(const SurfacePatches& patches, const QuadratureOptions& options = {});

/// That of one face of a ring type, or of a regular one (RingTypes::kPatch). Throws as surface_quadrature().
SurfaceQuadrature face_quadrature(bool quads, const RingTypes& types, Index type,
                                  const QuadratureOptions& options = {});

/// The quadrature's weights times |du x dv| of the surface: the integral of f over the area is the sum of f at the
/// places times these; their own sum is the area. Threaded.
Scalars area_weights(const LimitSurface& surface, const SurfaceQuadrature& quadrature);

}  // namespace batten
