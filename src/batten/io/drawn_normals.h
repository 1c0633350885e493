/// \file A unit normal for every corner that is drawn, for formats that must have one.
#pragma once
#include <cstdint>

#include "batten/io/write_check.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

/// One flag a face: tagged as a hole.
Buffer<std::uint8_t> hidden_faces(const Mesh& mesh);

/// The mesh's own normals, at unit length. Where it has none, or a zero: the mean of the faces' normals at the vertex,
/// weighted by area; where that is zero too (faces without area), +z. The mesh must outlive it.
class DrawnNormals {
 public:
  /// Throws Error(NotFinite); `name` is the file's. O(V + H), 24 bytes a vertex where a normal is missing.
  DrawnNormals(const std::string& name, const Mesh& mesh, const Buffer<std::uint8_t>& hidden);

  Eigen::RowVector3d at(Index corner) const { return unit(own_.row(mesh_, corner), mesh_.face_vertices[corner]); }
  /// Where no corner of the vertex has a normal of its own.
  Eigen::RowVector3d at_vertex(Index vertex) const { return unit(own_.attribute != nullptr ? vertex : -1, vertex); }

 private:
  /// A row that is there and not zero.
  bool is_given(Index row) const;
  Eigen::RowVector3d unit(Index row, Index vertex) const;

  const Mesh& mesh_;
  CornerList own_;
  Points smooth_ = Points(0, 3);
};

}  // namespace batten::io
