/// \file Surfaces of several labels of one volume that keep apart from each other.
#pragma once
#include <vector>

#include "batten/volume/segment_volume.h"

namespace batten {

/// One surface a label, and what kept them apart.
struct TogetherResult {
  std::vector<SegmentResult> surfaces;  ///< in the order of the labels
  std::int64_t first_meetings = 0;      ///< pairs of triangles of two surfaces that met before they were moved apart
  int rounds = 0;                       ///< that moved them apart
  double most_withdrawn = 0.0;          ///< how far the border was moved inwards at most, mm
};

/// Each label's surface is first found alone, as segment_mask() does. Each follows the wall between two neighbours as
/// smoothly as it can, so that they pass through each other in places. There the border that both are drawn to is moved
/// inwards, by a tenth of a voxel a round, until no triangles of two surfaces meet: elsewhere they share the wall. A
/// step after which a surface would meet itself is taken back.
/// request: the labels are `label`, two or more, each a surface of its own; what else a surface may start from or be
/// drawn to must be left out. Its watch is shown nothing. Throws Error: BadArgument; NotConverged naming the labels
/// that still meet when the border was moved by one and a half voxels; what segment_volume() throws; Cancelled.
TogetherResult segment_together(const Volume& image, const SegmentRequest& request, const Progress& progress = {});

/// Pairs of triangles of two meshes that pass through each other (mesh/self_intersections.h).
struct SurfaceMeeting {
  std::size_t first;         ///< the meshes
  std::size_t second;        ///< greater than `first`
  Eigen::RowVector3d place;  ///< the middle of the first one's triangle
};

/// Where closed meshes of triangles meet; what one of them does with itself does not count. O(n log n). Throws Error:
/// what Topology and find_self_intersections() throw.
std::vector<SurfaceMeeting> find_meetings(const std::vector<Mesh>& meshes, const Progress& progress = {});

}  // namespace batten
