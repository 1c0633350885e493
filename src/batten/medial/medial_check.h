/// \file What is wrong with the spokes of a medial model, and how far they are from a medial axis in Blum's sense.
#pragma once
#include <vector>

#include "batten/medial/medial_boundary.h"

namespace batten {

/// Two neighbouring spokes of one side that pass each other before they end: the boundary is folded there.
struct SpokeCrossing {
  Index first = -1;  ///< the vertices of MedialBoundary::mesh where they end
  Index second = -1;
};

/// What check_spokes finds. Two conditions make atoms medial in Blum's sense. An atom's spokes have one length; here
/// the difference of the two lengths, as a share of their mean. Spokes are normal to the boundary (Damon's
/// compatibility condition); here, along each edge of the boundary mesh from a to b with the unit spokes n, the angle
/// whose sine is |(n_a + n_b) / 2 . (b - a)| / |b - a|: 0 on planes, circles and spheres, and it falls with the square
/// of the spacing where the condition holds (key Damon03).
struct SpokeCheck {
  std::vector<SpokeCrossing> crossings;
  double max_tilt = 0.0;  ///< in radians
  double mean_tilt = 0.0;
  Index tilt_vertex = -1;              ///< an end of the worst edge
  double max_length_difference = 0.0;  ///< as a share
  double mean_length_difference = 0.0;
  Index length_vertex = -1;  ///< where the atom's upward spoke ends
};

/// boundary: as medial_boundary returns it. Spokes pass each other where the vector from one to the other turns by a
/// right angle or more between their starts and their ends. O(vertices).
SpokeCheck check_spokes(const MedialBoundary& boundary);

}  // namespace batten
