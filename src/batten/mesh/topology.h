/// \file The trusted connectivity of a mesh: half-edge tables, built once.
///
/// A face's half-edges are contiguous: face f owns [face_begin(f), face_end(f)). Half-edge h runs from origin(h) to
/// origin(next(h)) with its face on the left. At a boundary the twin is -1. vertex_half_edge(v) starts v's fan: at a
/// boundary vertex it is the outgoing half-edge of the boundary, so that turning counter-clockwise visits every face
/// once.
#pragma once
#include <memory>

#include "batten/buffer.h"
#include "batten/mesh/mesh.h"
#include "batten/types.h"

namespace batten {

/// The tables of a Topology, for operators that derive one topology from another in closed form.
struct TopologyTables {
  Index vertex_count = 0;
  Index uniform_face_size = 0;      ///< the number of corners of every face, or 0 if it differs
  Buffer<Index> face_offsets;       ///< F+1
  Buffer<Index> origins;            ///< H
  Buffer<Index> twins;              ///< H, -1 at a boundary
  Buffer<Index> faces;              ///< H
  Buffer<Index> edges;              ///< H
  Buffer<Index> edge_half_edges;    ///< E: the lower half-edge of each edge
  Buffer<Index> vertex_half_edges;  ///< V, -1 for a vertex without a face
  Buffer<float> edge_sharpness;     ///< E, or empty if no edge is tagged; without boundary edges
  Buffer<float> vertex_sharpness;   ///< V, or empty
  Buffer<std::uint8_t> holes;       ///< F, or empty
};

/// Immutable and safe to share between threads. Memory: 16 bytes for each half-edge and 8 to 12 for each vertex. A
/// Topology is a handle: copies are cheap and share the tables, which live as long as the last copy. An operator keeps
/// a copy and therefore never dangles.
class Topology {
 public:
  /// Checks the mesh and builds the tables. O(V + H), without an allocation for each face. Throws Error:
  /// IndexOutOfRange, NotFinite, DegenerateFace, RepeatedFace, NonManifoldEdge, NonManifoldVertex, InconsistentFaces,
  /// NonOrientable, TooLarge, BadShape, BadArgument (a crease that is no edge), Cancelled. Vertices without a face are
  /// allowed.
  explicit Topology(const Mesh& mesh, const Progress& progress = {});

  Topology(const Topology&) = default;
  Topology& operator=(const Topology&) = default;

  /// Does not check the tables. For Refinement and other operators of the library.
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
  /// The vertex must have faces.
  bool is_boundary_vertex(Index vertex) const { return twin(vertex_half_edge(vertex)) < 0; }
  /// The number of faces at the vertex. A boundary vertex has one more edge than faces.
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
  /// The sharpness of an edge; boundary edges are infinitely sharp.
  float edge_sharpness(Index edge) const {
    if (is_boundary_edge(edge)) return kInfiniteSharpness;
    return has_creases() ? tables_->edge_sharpness[edge] : 0.0F;
  }
  /// The vertex's tag. It does not include the sharpness that a boundary rule adds.
  float vertex_sharpness(Index vertex) const { return has_corners() ? tables_->vertex_sharpness[vertex] : 0.0F; }
  bool is_hole(Index face) const { return has_holes() && tables_->holes[face] != 0; }

  const TopologyTables& tables() const { return *tables_; }

 private:
  explicit Topology(std::shared_ptr<const TopologyTables> tables) : tables_(std::move(tables)) {}

  // Never null: the class has no move constructor that would leave a null pointer.
  std::shared_ptr<const TopologyTables> tables_;
};

/// Throws Error(BadShape) unless values has one row for each vertex.
void require_vertex_rows(const Topology& topology, ConstValuesRef values);

/// The component of each vertex; components are connected by faces and numbered by their lowest vertex. An isolated
/// vertex is a component of its own.
struct Components {
  Buffer<Index> of_vertex;
  Index count = 0;
};
/// O(H).
Components connected_components(const Topology& topology);

/// A mesh with the faces and tags of a topology. The caller adds points and attributes.
Mesh mesh_from_topology(const Topology& topology);

}  // namespace batten
