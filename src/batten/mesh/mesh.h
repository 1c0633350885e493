/// \file A mesh as a file holds it: plain data that any program may build and that the library never trusts.
///
/// Topology (mesh/topology.h) checks a Mesh before anything is computed from it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// An edge that the surface keeps sharp for `sharpness` levels, or forever at kInfiniteSharpness and more.
struct Crease {
  Index a;
  Index b;
  double sharpness;
};

/// A vertex that keeps its position for `sharpness` levels.
struct Corner {
  Index vertex;
  double sharpness;
};

/// Named rows of numbers. At vertices, corner_rows is empty and row i belongs to vertex i. At corners, corner_rows has
/// one entry for each entry of Mesh::face_vertices: the row of `values`, or -1 where the file has no value.
/// Conventional names: "uv" (k = 2), "normal" (k = 3), "color" (k = 3 or 4, in [0, 1]).
struct Attribute {
  std::string name;
  Values values;
  Buffer<Index> corner_rows;
  /// At vertices, what refinement does with them; at corners Mesh::face_varying says it. No file holds it.
  CarryRule carry = CarryRule::Scheme;

  bool per_corner() const { return !corner_rows.empty(); }
};

/// A group (OBJ: g, o, usemtl, s) of the faces from `first_face` up to the next Group with the same keyword.
struct Group {
  std::string keyword;
  std::string name;
  Index first_face;
};

/// The content of a mesh file, or a mesh that a program builds itself.
struct Mesh {
  Points points = Points(0, 3);   ///< V-by-3, in the file's unit
  Buffer<Index> face_offsets{0};  ///< F+1: face f has the corners [face_offsets[f], face_offsets[f+1])
  Buffer<Index> face_vertices;    ///< the vertex of each corner, counter-clockwise seen from outside
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<Index> holes;  ///< faces that shape the surface but are not part of it
  std::vector<Attribute> attributes;
  std::vector<Group> groups;
  std::vector<std::string> material_libraries;  ///< OBJ: mtllib; kept for writers
  /// The choices about the surface that the file makes.
  std::optional<SchemeKind> scheme;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;
  std::optional<FaceVaryingRule> face_varying;

  Index vertex_count() const { return static_cast<Index>(points.rows()); }
  Index face_count() const { return static_cast<Index>(face_offsets.size()) - 1; }
  Index face_size(Index face) const { return face_offsets[face + 1] - face_offsets[face]; }
  void add_face(std::initializer_list<Index> vertices) {
    face_vertices.insert(face_vertices.end(), vertices);
    face_offsets.push_back(static_cast<Index>(face_vertices.size()));
  }
};

/// The length of the bounding box's diagonal, to which tolerances are relative. 0 for an empty mesh.
double bounding_diagonal(ConstValuesRef points);

/// True if the mesh has faces and each has three corners.
bool all_triangles(const Mesh& mesh);

}  // namespace batten
