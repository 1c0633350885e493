/// \file A triangle mesh with sharp edges and the points that are attached to its Loop surface, for local moves.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "batten/buffer.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// Where a point is nearest to the surface.
struct FacetAttachment {
  Index face = -1;
  Index facet = 0;      ///< of the face (fit/local_loop.h)
  double square = 0.0;  ///< the distance
};

/// The mesh lists what is at each vertex, so that a move costs what it touches.
class LoopState {
 public:
  /// mesh: triangles that Topology accepts; its creases become sharp edges for good, whatever their sharpness.
  LoopState(const Mesh& mesh, const Points& points);

  Index vertex_count() const { return vertices_; }
  /// Numbers run to this, those of vertices that are gone included.
  Index vertex_end() const { return static_cast<Index>(places_.size()); }
  Index face_end() const { return static_cast<Index>(faces_.size()); }
  bool has_vertex(Index v) const { return !fans_[v].empty(); }
  bool has_face(Index f) const { return faces_[f][0] >= 0; }
  const Eigen::Vector3d& place(Index v) const { return places_[v]; }
  const std::array<Index, 3>& face(Index f) const { return faces_[f]; }
  const std::vector<Index>& fan(Index v) const { return fans_[v]; }
  const std::vector<Index>& sharp_neighbours(Index v) const { return sharp_[v]; }
  bool is_sharp(Index a, Index b) const;
  std::vector<Index> neighbours(Index v) const;  ///< ascending
  bool is_boundary(Index v) const { return neighbours(v).size() != fans_[v].size(); }
  /// The faces at an edge, one or two.
  std::vector<Index> faces_at(Index a, Index b) const;
  /// The corner of a face across from an edge.
  Index across(Index f, Index a, Index b) const;
  /// Each edge once, the lower vertex first, ascending.
  std::vector<std::array<Index, 2>> edges() const;

  const Points& points() const { return points_; }
  const FacetAttachment& attachment(Index point) const { return attached_[point]; }
  const std::vector<Index>& points_of(Index face) const { return points_of_[face]; }
  double squares() const;            ///< of all distances
  double squares_of(Index f) const;  ///< of the points of a face

  /// Attaches every point anew.
  void attach_all();
  Mesh mesh() const;

  // What moves are made of.
  Index add_vertex(const Eigen::Vector3d& place);
  void move_vertex(Index v, const Eigen::Vector3d& place) { places_[v] = place; }
  Index add_face(const std::array<Index, 3>& corners);
  void drop_face(Index f);
  void set_face(Index f, const std::array<Index, 3>& corners);
  void set_sharp(Index a, Index b, bool sharp);
  void attach(Index point, const FacetAttachment& to);

 private:
  Points points_;
  Index vertices_ = 0;
  std::vector<Eigen::Vector3d> places_;
  std::vector<std::array<Index, 3>> faces_;
  std::vector<std::vector<Index>> fans_;
  std::vector<std::vector<Index>> sharp_;
  std::vector<FacetAttachment> attached_;
  std::vector<std::vector<Index>> points_of_;
};

}  // namespace batten
