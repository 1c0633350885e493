/// \file A mesh as a file holds it: plain data that anyone may build and nothing may trust.
///
/// Topology (mesh/topology.h) is the gate between a Mesh and everything that computes.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// An edge that the surface keeps sharp for `sharpness` levels; kInfiniteSharpness or more: for ever.
struct Crease {
  Index a;
  Index b;
  double sharpness;
};

/// A vertex that stays where it is for `sharpness` levels.
struct Corner {
  Index vertex;
  double sharpness;
};

/// Named rows of numbers at vertices (corner_rows empty: row i belongs to vertex i) or at corners (corner_rows has one
/// entry per entry of Mesh::face_vertices: the row of `values`, or -1 where the file gives none).
/// Conventional names: "uv" (k = 2), "normal" (k = 3), "color" (k = 3 or 4, in [0, 1]).
struct Attribute {
  std::string name;
  Values values;
  Buffer<Index> corner_rows;

  bool per_corner() const { return !corner_rows.empty(); }
};

/// Faces from `first_face` on belong to this group until the next Group of the same keyword (OBJ: g, o, usemtl, s).
struct Group {
  std::string keyword;
  std::string name;
  Index first_face;
};

/// What a file holds, and what a program may build itself.
struct Mesh {
  Points points = Points(0, 3);   ///< V-by-3, in the file's unit
  Buffer<Index> face_offsets{0};  ///< F+1: face f has the corners [face_offsets[f], face_offsets[f+1])
  Buffer<Index> face_vertices;    ///< the vertex of each corner, counter-clockwise seen from outside
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<Index> holes;  ///< faces that shape the surface but are not drawn
  std::vector<Attribute> attributes;
  std::vector<Group> groups;
  std::vector<std::string> material_libraries;  ///< OBJ: mtllib, passed through
  /// The file's word on the surface, where it has one.
  std::optional<SchemeKind> scheme;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;

  Index vertex_count() const { return static_cast<Index>(points.rows()); }
  Index face_count() const { return static_cast<Index>(face_offsets.size()) - 1; }
  Index face_size(Index face) const { return face_offsets[face + 1] - face_offsets[face]; }
  void add_face(std::initializer_list<Index> vertices) {
    face_vertices.insert(face_vertices.end(), vertices);
    face_offsets.push_back(static_cast<Index>(face_vertices.size()));
  }
};

/// The length of the bounding box's diagonal: the length that tolerances are relative to. 0 for an empty mesh.
double bounding_diagonal(ConstValuesRef points);

/// True where every face has three corners (and there is a face).
bool all_triangles(const Mesh& mesh);

}  // namespace batten
