/// \file A mesh under repair: its faces and the origin of each corner, face and vertex. The functions are the steps of
/// mesh/repair.h.
#pragma once
#include "batten/mesh/repair.h"
#include "batten/mesh/sheets.h"
#include "batten/mesh/sides.h"

namespace batten {

struct Draft {
  explicit Draft(const Mesh& mesh) : input(mesh) {}

  const Mesh& input;
  Buffer<Index> offsets{0};
  Buffer<Index> vertices;        ///< for each corner; some vertices may be unused
  Buffer<Index> corner_sources;  ///< for each corner, the input's corner
  Buffer<Index> face_sources;
  Buffer<Index> vertex_sources;   ///< for each vertex; the input's vertices come first, then copies
  Buffer<std::uint8_t> reversed;  ///< for each face, 1 if reversed with respect to the input

  Index face_count() const { return static_cast<Index>(face_sources.size()); }
  Index vertex_count() const { return static_cast<Index>(vertex_sources.size()); }
  Eigen::Vector3d point(Index vertex) const { return input.points.row(vertex_sources[vertex]).transpose(); }
  Index source(Index vertex) const { return vertex_sources[vertex]; }
  /// Newell's normal, not of unit length.
  Eigen::Vector3d normal(Index face) const;
  /// The face at an edge in the form that match_sheets() takes.
  EdgeFace edge_face(Index side, const SideTable& sides, const Orientation& orientation, bool forward) const;

  void add_corner(Index vertex, Index corner_source);
  void end_face(Index face_source, bool is_reversed);
  /// A draft with the same vertices and no faces, which the caller adds.
  Draft without_faces() const;
  void copy_face(const Draft& other, Index face);
  void take_faces(Draft& other);
  void drop_faces(const Buffer<std::uint8_t>& dropped);
  void reverse(const Buffer<std::uint8_t>& faces);
};

/// Records changes by kind.
class RepairLog {
 public:
  void add(RepairKind kind, Index element) { of(kind).elements.push_back(element); }
  void add_edge(Index a, Index b, RepairKind kind) {
    add(kind, a);
    add(kind, b);
  }
  void count_tag() { ++of(RepairKind::DroppedTags).count; }
  /// The changes that happened, with counts and sentences.
  std::vector<RepairChange> take();

 private:
  RepairChange& of(RepairKind kind);
  std::vector<RepairChange> changes_;
};

/// Step 1 except repeated faces: a draft of the input's usable faces.
Draft draft_of(const Mesh& input, RepairLog& log);
/// Simplifies or drops faces whose vertices repeat. Returns true if there were any.
bool simplify_faces(Draft& draft, RepairLog& log);
/// Keeps the first of several faces with the same vertices, in either direction. Two faces of opposite directions are
/// both kept where they close a pillow of their own, and where they are a wall between two bodies: where every edge has
/// two more faces that are not repeated.
void drop_repeated_faces(Draft& draft, RepairLog& log);

/// Steps 2 to 4: makes the draft an oriented manifold.
void split(Draft& draft, RepairLog& log);

/// Reverses all faces of the closed components in which a face was reversed, if their normals point inwards. The draft
/// must be a manifold.
void turn_outwards(Draft& draft);

/// The open edges of a draft that is a manifold.
struct Rim {
  /// Vertices within the tolerance of each other are at the same place; see place_numbers().
  Rim(const Draft& draft, double tolerance);

  SideTable sides;
  SidePairs pairs;
  Buffer<Index> places;  ///< of each vertex at the boundary; -1 for others
  Buffer<Index> open;    ///< the sides without a partner
};

/// Collapses open edges of length 0 and drops single faces that lie on another face; split() must follow. Returns true
/// if there were any.
bool collapse(Draft& draft, const Rim& rim, RepairLog& log);
/// Step 5: welds everything that one round can weld. The draft stays an oriented manifold. Returns true if anything was
/// welded.
bool stitch(Draft& draft, const Rim& rim);

}  // namespace batten
