/// \file Which faces belong together where more than two meet in an edge.
#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "batten/types.h"

namespace batten {

/// A face at an edge.
struct EdgeFace {
  Index side;
  Index piece;             ///< faces of the same piece hang together elsewhere
  bool forward;            ///< the direction in which the (oriented) face passes the edge
  Eigen::Vector3d normal;  ///< of the face as the file has it, any length
  bool listed_forward;     ///< the direction in which the file has it
};

/// Where a face stands around an edge from `axis`' start to its end, in 65,536ths of a turn. Coarse, so that rounding
/// does not decide between equal angles.
Index angle_around(const Eigen::Vector3d& axis, const EdgeFace& face);

/// Pairs of faces that pass the edge in opposite directions: within a piece first, then any; the flattest first, of
/// equal ones the convex one. O(n log n); what is left over is in no pair.
std::vector<std::pair<Index, Index>> match_sheets(const Eigen::Vector3d& axis, const std::vector<EdgeFace>& faces);

}  // namespace batten
