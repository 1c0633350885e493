/// \file A unit normal for every visible corner, for formats that require one.
#pragma once
#include <cstdint>

#include "batten/io/write_check.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

/// A flag for each face: 1 if it is tagged as a hole.
Buffer<std::uint8_t> hidden_faces(const Mesh& mesh);

/// The mesh's own normals at unit length. Where a normal is missing or zero, it is the mean of the faces' normals at
/// the vertex, weighted by area, or +z where all of these faces have no area. The mesh must outlive this object.
class DrawnNormals {
 public:
  /// `name` is the file's. O(V + H), 24 bytes for each vertex if a normal is missing. Throws Error(NotFinite).
  DrawnNormals(const std::string& name, const Mesh& mesh, const Buffer<std::uint8_t>& hidden);

  Eigen::RowVector3d at(Index corner) const { return unit(own_.row(mesh_, corner), mesh_.face_vertices[corner]); }
  /// The normal at a vertex none of whose corners has a normal of its own.
  Eigen::RowVector3d at_vertex(Index vertex) const { return unit(own_.attribute != nullptr ? vertex : -1, vertex); }

 private:
  /// True if the row exists and is not zero.
  bool is_given(Index row) const;
  Eigen::RowVector3d unit(Index row, Index vertex) const;

  const Mesh& mesh_;
  CornerList own_;
  Points smooth_ = Points(0, 3);
};

}  // namespace batten::io
