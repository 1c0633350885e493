/// \file The limit position and the limit normal of single vertices, with the control points that they depend on.
///
/// Where only a few vertices matter, such as those of a control mesh in a mesh refined from it, this costs a fraction
/// of LimitMatrix and limit_normals(), which visit all.
#pragma once
#include <Eigen/Geometry>

#include "batten/limit/ring_limit.h"

namespace batten {

/// What decides how many normals a vertex has.
enum class FrameKind : std::uint8_t {
  Interior,    ///< one normal
  Boundary,    ///< one normal, across a boundary curve
  Crease,      ///< a normal on each side
  Corner,      ///< a cone
  ValenceTwo,  ///< two faces inside the surface: no normal
  Degenerate,  ///< the tangents are zero or parallel: no normal
  Outside      ///< no face that is part of the surface
};

/// The limit at one vertex. `normal` is a unit vector for Interior and Boundary, else zero; `along` is one of the two
/// tangents, of any length, at a boundary the one along the curve.
struct VertexFrame {
  FrameKind kind = FrameKind::Outside;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
};

/// The masks of a vertex, on its ring.
struct FrameMasks {
  FrameKind kind = FrameKind::Outside;
  RingMask position;
  TangentMasks tangents;
};

/// What a frame depends on: the vertex, its neighbours along edges, and under Catmull-Clark the corners across its
/// quads; only the vertex where it has no face. Working memory that calls share.
struct FrameRing {
  std::vector<Index> vertices;
  const FrameMasks* masks = nullptr;  ///< null: Outside
  FrameMasks own;                     ///< what `masks` refers to where they are not the usual ones
  VertexRing around;
};

/// Frames of a mesh of quads under Catmull-Clark or of triangles under Loop. Build O(1). Safe to share.
class VertexFrames {
 public:
  /// Keeps a copy of the topology.
  VertexFrames(const Topology& topology, const Scheme& scheme);

  /// Finds the ring of a vertex and its masks. O(valence); more where tags are near.
  void find(Index vertex, FrameRing& ring) const;
  /// The frame of the vertex whose ring was found. control: V-by-3. O(valence).
  static VertexFrame frame(ConstValuesRef control, const FrameRing& ring);

 private:
  bool gather_closed(Index vertex, std::vector<Index>& vertices) const;
  void find_tagged(Index vertex, FrameRing& ring) const;

  Topology topology_;
  Scheme scheme_;
  bool is_plain_;                   ///< no tags and no holes
  std::vector<FrameMasks> smooth_;  ///< by valence
};

}  // namespace batten
