/// \file The trusted connectivity of a mesh: half-edge tables, built once.
///
/// A face's half-edges are contiguous: face f owns [face_begin(f), face_end(f)), half-edge h runs from origin(h) to
/// origin(next(h)), and the face lies to its left. At a boundary the twin is -1. vertex_half_edge(v) starts v's fan: at
/// a boundary vertex it is the boundary's outgoing half-edge, so that turning counter-clockwise meets every face once.
#pragma once
#include <memory>

#include "batten/buffer.h"
#include "batten/mesh/mesh.h"
#include "batten/types.h"

namespace batten {

/// What a Topology is made of; for operators that derive one topology from another in closed form.
struct TopologyTables {
  Index vertex_count = 0;
  Index uniform_face_size = 0;      ///< the number of corners of every face, or 0 where they differ
  Buffer<Index> face_offsets;       ///< F+1
  Buffer<Index> origins;            ///< H
  Buffer<Index> twins;              ///< H, -1 at a boundary
  Buffer<Index> faces;              ///< H
  Buffer<Index> edges;              ///< H
  Buffer<Index> edge_half_edges;    ///< E: the lower half-edge of each edge
  Buffer<Index> vertex_half_edges;  ///< V, -1 for a vertex without a face
  Buffer<float> edge_sharpness;     ///< E, or empty where no edge is tagged; boundary edges not included
  Buffer<float> vertex_sharpness;   ///< V, or empty
  Buffer<std::uint8_t> holes;       ///< F, or empty
};

/// Immutable and safe to share between threads. Memory: 16 bytes a half-edge and 8 to 12 a vertex. A handle: copies are
/// cheap and share the tables, which live as long as the last of them, so that what is built from a topology keeps its
/// own and needs nobody else's.
class Topology {
 public:
  /// The gate. O(V + H), no allocation per face. Throws Error: IndexOutOfRange, NotFinite, DegenerateFace,
  /// RepeatedFace, NonManifoldEdge, NonManifoldVertex, InconsistentFaces, NonOrientable, TooLarge, BadShape,
  /// BadArgument (a crease that is no edge), Cancelled. Vertices without a face are allowed.
  explicit Topology(const Mesh& mesh, const Progress& progress = {});

  Topology(const Topology&) = default;
  Topology& operator=(const Topology&) = default;

  /// Trusts its caller: for Refinement and the like.
  static Topology from_tables(TopologyTables tables);

  Index vertex_count() const { return tables_->vertex_count; }
  Index face_count() const { return static_cast<Index>(tables_->face_offsets.size()) - 1; }
  Index edge_count() const { return static_cast<Index>(tables_->edge_half_edges.size()); }
  Index half_edge_count() const { return static_cast<Index>(tables_->origins.size()); }

  Index face_begin(Index face) const { return tables_->face_offsets[face]; }
  Index face_end(Index face) const { return tables_->face_offsets[face + 1]; }
  Index face_size(Index face) const { return face_end(face) - face_begin(face); }
  Index uniform_face_size() const { return tables_->uniform_face_size; }

  Index origin(Index half_edge) const { return tables_->origins[half_edge]; }
  Index destination(Index half_edge) const { return origin(next(half_edge)); }
  Index twin(Index half_edge) const { return tables_->twins[half_edge]; }
  Index face(Index half_edge) const { return tables_->faces[half_edge]; }
  Index edge(Index half_edge) const { return tables_->edges[half_edge]; }
  Index next(Index half_edge) const {
    const Index f = face(half_edge);
    return half_edge + 1 == face_end(f) ? face_begin(f) : half_edge + 1;
  }
  Index previous(Index half_edge) const {
    const Index f = face(half_edge);
    return half_edge == face_begin(f) ? face_end(f) - 1 : half_edge - 1;
  }

  Index edge_half_edge(Index edge) const { return tables_->edge_half_edges[edge]; }
  bool is_boundary_edge(Index edge) const { return twin(edge_half_edge(edge)) < 0; }

  Index vertex_half_edge(Index vertex) const { return tables_->vertex_half_edges[vertex]; }
  bool is_isolated(Index vertex) const { return vertex_half_edge(vertex) < 0; }
  /// At a vertex with faces.
  bool is_boundary_vertex(Index vertex) const { return twin(vertex_half_edge(vertex)) < 0; }
  /// Number of faces at the vertex; a boundary vertex has one edge more than faces.
  Index vertex_face_count(Index vertex) const;

  /// Calls visit(h) for the outgoing half-edges of a vertex, counter-clockwise from the start of its fan.
  template <typename Visit>
  void for_each_outgoing(Index vertex, const Visit& visit) const {
    const Index start = vertex_half_edge(vertex);
    for (Index h = start; h >= 0;) {
      visit(h);
      h = twin(previous(h));
      if (h == start) break;
    }
  }

  bool has_creases() const { return !tables_->edge_sharpness.empty(); }
  bool has_corners() const { return !tables_->vertex_sharpness.empty(); }
  bool has_holes() const { return !tables_->holes.empty(); }
  /// Boundary edges are infinitely sharp.
  float edge_sharpness(Index edge) const {
    if (is_boundary_edge(edge)) return kInfiniteSharpness;
    return has_creases() ? tables_->edge_sharpness[edge] : 0.0F;
  }
  /// As tagged; what a boundary rule adds is not in it.
  float vertex_sharpness(Index vertex) const { return has_corners() ? tables_->vertex_sharpness[vertex] : 0.0F; }
  bool is_hole(Index face) const { return has_holes() && tables_->holes[face] != 0; }

  const TopologyTables& tables() const { return *tables_; }

 private:
  explicit Topology(std::shared_ptr<const TopologyTables> tables) : tables_(std::move(tables)) {}

  std::shared_ptr<const TopologyTables> tables_;  // never null: there is no move that would leave nothing behind
};

/// Throws Error(BadShape) unless values has one row a vertex.
void require_vertex_rows(const Topology& topology, ConstValuesRef values);

/// Component of each vertex by faces, numbered by their lowest vertex; an isolated vertex is a component of its own.
struct Components {
  Buffer<Index> of_vertex;
  Index count = 0;
};
/// O(H).
Components connected_components(const Topology& topology);

/// Faces as a mesh's arrays, with the tags; points and attributes are the caller's.
Mesh mesh_from_topology(const Topology& topology);

}  // namespace batten
