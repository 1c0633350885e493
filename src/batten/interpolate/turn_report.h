/// \file What became of the normals that a surface should have.
#pragma once
#include "batten/mesh/vertex_measure.h"

namespace batten {

/// How many vertices of each kind; those at creases, corners and so on are left as they are.
struct TurnCounts {
  Index unwanted = 0;      ///< without a wanted normal
  Index kept = 0;          ///< within the tolerance from the start
  Index turned = 0;        ///< the surface has the wanted normal now
  Index boundary = 0;      ///< of those turned: at a boundary, whose curve turned too unless it met the normal squarely
  Index opposed = 0;       ///< of those kept or turned: more than 90 degrees off at first
  Index antiparallel = 0;  ///< of those turned: opposite to rounding, so turned about a tangent of the surface
  Index crease = 0;        ///< a normal on each side
  Index corner = 0;        ///< a cone
  Index valence_two = 0;   ///< two faces inside the surface, which has no normal there
  Index degenerate = 0;    ///< no tangent plane, since tangents are zero or parallel
  Index outside = 0;       ///< on no face of the surface

  /// Wanted, but the surface has not one normal there.
  Index skipped() const { return crease + corner + valence_two + degenerate + outside; }
};

/// The thin-plate energy of the surface (SurfaceEnergy, in the parameters of the twice refined faces, unit^2): how much
/// it bends, and so how much it ripples.
struct TurnEnergy {
  double before = 0.0;
  double turned = 0.0;   ///< after the turns alone
  double relaxed = 0.0;  ///< at the end; least for the displacement, not for the surface
  int iterations = 0;    ///< of conjugate gradients
};

/// Angles between wanted and reached normals at the vertices given, in radians, measured at the start and at the end;
/// NaN where no normal is wanted or the surface has not one.
struct TurnReport {
  Scalars before;
  Scalars after;
  VertexMeasure before_angle;
  VertexMeasure after_angle;
  TurnCounts counts;
  TurnEnergy energy;  ///< zeros where nothing was relaxed
};

}  // namespace batten
