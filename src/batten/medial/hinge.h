/// \file Where the boundaries of two figures are joined.
#pragma once
#include <vector>

#include "batten/medial/medial_boundary.h"

namespace batten {

/// Where a face of the boundary comes from.
struct BoundaryFace {
  Index figure;
  SpokeSide side;  ///< Crest: of a strip along the boundary of the sheet
  Index first;     ///< the face of the sheet, or the first atom of the edge of the sheet
  Index second;    ///< the second atom of that edge; -1 for a face of the sheet
};

/// Opens the boundary at each hinge and joins the openings; leaves out vertices without a face. origins: one for each
/// face. Throws Error(IndexOutOfRange, BadArgument) naming the hinge.
void join_figures(const MedialModel& model, const std::vector<BoundaryFace>& origins, MedialBoundary& boundary);

}  // namespace batten
