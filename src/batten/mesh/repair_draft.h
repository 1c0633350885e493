/// \file A mesh under repair: its faces, and where each corner, face and vertex comes from. The steps of mesh/repair.h.
#pragma once
#include "batten/mesh/repair.h"
#include "batten/mesh/sheets.h"
#include "batten/mesh/sides.h"

namespace batten {

struct Draft {
  explicit Draft(const Mesh& mesh) : input(mesh) {}

  const Mesh& input;
  Buffer<Index> offsets{0};
  Buffer<Index> vertices;        ///< per corner; may leave vertices unused
  Buffer<Index> corner_sources;  ///< per corner: the input corner
  Buffer<Index> face_sources;
  Buffer<Index> vertex_sources;   ///< per vertex; the input's vertices first, then copies
  Buffer<std::uint8_t> reversed;  ///< per face: against the input

  Index face_count() const { return static_cast<Index>(face_sources.size()); }
  Index vertex_count() const { return static_cast<Index>(vertex_sources.size()); }
  Eigen::Vector3d point(Index vertex) const { return input.points.row(vertex_sources[vertex]).transpose(); }
  Index source(Index vertex) const { return vertex_sources[vertex]; }
  /// Newell's, not of unit length.
  Eigen::Vector3d normal(Index face) const;
  /// A face at an edge, for match_sheets().
  EdgeFace edge_face(Index side, const SideTable& sides, const Orientation& orientation, bool forward) const;

  void add_corner(Index vertex, Index corner_source);
  void end_face(Index face_source, bool is_reversed);
  /// The same vertices, no faces: to be filled again.
  Draft without_faces() const;
  void copy_face(const Draft& other, Index face);
  void take_faces(Draft& other);
  void drop_faces(const Buffer<std::uint8_t>& dropped);
  void reverse(const Buffer<std::uint8_t>& faces);
};

/// The changes as they are met, kind by kind.
class RepairLog {
 public:
  void add(RepairKind kind, Index element) { of(kind).elements.push_back(element); }
  void add_edge(Index a, Index b, RepairKind kind) {
    add(kind, a);
    add(kind, b);
  }
  void count_tag() { ++of(RepairKind::DroppedTags).count; }
  /// Those that happened, with counts and sentences.
  std::vector<RepairChange> take();

 private:
  RepairChange& of(RepairKind kind);
  std::vector<RepairChange> changes_;
};

/// Step 1 without repeated faces: the input's usable faces.
Draft draft_of(const Mesh& input, RepairLog& log);
/// Faces whose vertices repeat are simplified or dropped. True when any was.
bool simplify_faces(Draft& draft, RepairLog& log);
/// Of faces with the same vertices around, in whatever direction, the first stays. Two of opposite directions both stay
/// where they close a pillow of their own, and as a wall between two bodies: where every edge has two more faces that
/// are not given twice.
void drop_repeated_faces(Draft& draft, RepairLog& log);

/// Steps 2 to 4: afterwards the draft is an oriented manifold.
void split(Draft& draft, RepairLog& log);

/// Closed components in which a face was reversed: all faces, where their normals point inwards. The draft must be a
/// manifold.
void turn_outwards(Draft& draft);

/// The open edges of a draft that is a manifold.
struct Rim {
  /// Vertices within the tolerance of each other are at one place; see place_numbers().
  Rim(const Draft& draft, double tolerance);

  SideTable sides;
  SidePairs pairs;
  Buffer<Index> places;  ///< of each vertex at the boundary; -1 inside
  Buffer<Index> open;    ///< sides without a partner
};

/// Open edges without length are closed up, single faces that lie on another are dropped; needs split() afterwards.
/// True when anything was.
bool collapse(Draft& draft, const Rim& rim, RepairLog& log);
/// Step 5: welds what can be at one go; the draft stays an oriented manifold. True when anything was.
bool stitch(Draft& draft, const Rim& rim);

}  // namespace batten
