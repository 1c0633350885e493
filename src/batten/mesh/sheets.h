/// \file Which faces belong together at an edge of more than two faces.
#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "batten/types.h"

namespace batten {

/// A face at an edge.
struct EdgeFace {
  Index side;
  Index piece;             ///< faces of the same piece are connected elsewhere
  bool forward;            ///< the direction in which the (oriented) face passes the edge
  Eigen::Vector3d normal;  ///< of the face as stored in the file, any length
  bool listed_forward;     ///< the direction in which the file's face passes the edge
};

/// The angle of a face around an edge from the start of `axis` to its end, in 65,536ths of a turn. The unit is coarse,
/// so that rounding does not decide between equal angles.
Index angle_around(const Eigen::Vector3d& axis, const EdgeFace& face);

/// Pairs of faces that pass the edge in opposite directions: first within a piece, then any. The flattest pair comes
/// first; of equally flat ones, the convex one. Faces left over are in no pair. O(n log n).
std::vector<std::pair<Index, Index>> match_sheets(const Eigen::Vector3d& axis, const std::vector<EdgeFace>& faces);

}  // namespace batten
