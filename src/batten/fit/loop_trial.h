/// \file One local change of a Loop surface, tried on the limit surface around it.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "batten/fit/loop_facets.h"
#include "batten/fit/loop_state.h"

namespace batten {

/// What can be done at an edge, or at a vertex (Place).
enum class LoopMoveKind {
  Place,     ///< vertex a moves
  Collapse,  ///< b becomes one with a
  Split,     ///< a vertex halves the edge
  Swap,      ///< the edge turns to the corners across
  Sharpen,   ///< the edge becomes sharp, or smooth if it is
};

/// A move and what it gained where it was tried.
struct LoopMove {
  LoopMoveKind kind = LoopMoveKind::Place;
  Index a = 0;
  Index b = 0;
  double gain = 0.0;
};

/// Tries moves (Hoppe and others 1993, 1994, keys HDDMS93, HDDH94): the few control points that a move changes go to
/// where the squared distances of the points around are least, by steps to second order in the distance from facets of
/// the limit surface (fit/loop_facets.h). An object keeps its memory; one thread uses it.
class LoopTrial {
 public:
  /// fairness: what the squared distance of a control point from the mean of its neighbours costs, on sharp lines from
  /// the mean of its two neighbours there.
  LoopTrial(const LoopState& state, double fairness, FacetStencils& stencils);

  /// How much smaller the sum of squared distances and bends becomes; minus infinity where the move would change the
  /// topology or the net of sharp edges, make a valence below 3 or above 12 at an inner vertex, or fold the surface
  /// over.
  double gain(const LoopMove& move, int steps);
  /// Makes the move of the last gain(), which was finite, in the state that it was tried on.
  void commit(LoopState& state) const;

 private:
  struct EditedFace {
    std::array<Index, 3> corners;
    Index id;    ///< in the state; -1: new
    bool fresh;  ///< its points are sought among all facets of fresh faces
  };
  struct LocalPoint {
    Index point;
    Index facet;  ///< of the local surface; -1: not yet known
    double square;
  };
  bool is_allowed(const LoopMove& move) const;
  bool collapse_allowed(Index a, Index b) const;
  void gather(std::span<const Index> seeds);
  void edit(const LoopMove& move);
  bool edited_sharp(Index u, Index v) const;
  void order_faces();
  void build();
  void find_bends();
  double bends_before() const;
  double bends_after() const;
  Eigen::Vector3d at(const FreePlace& place) const;
  void place_facets();
  void gather_points();
  void project(LocalPoint& point);
  double project_all();
  void step();
  bool folds() const;
  bool folded_before();
  double optimize(int steps);

  const LoopState* state_;
  double fairness_;
  LoopMove move_;
  std::vector<Index> face_mark_;
  std::vector<Index> local_of_;
  Index round_ = 0;
  std::vector<Index> faces_;  ///< of the state, around the move
  std::vector<EditedFace> edited_;
  std::vector<EditedFace> ordered_;
  std::vector<std::uint8_t> taken_;
  std::vector<Index> near_mark_;
  std::vector<Index> dropped_;
  std::vector<Index> free_;  ///< vertices; those from vertex_end() on are new
  std::vector<Eigen::Vector3d> free_place_;
  std::vector<Index> vertices_;  ///< local to the state's number
  LocalFaces local_;
  std::vector<FreePlace> places_;  ///< of the vertices of local_
  LoopFacets surface_;
  std::vector<Eigen::Vector3d> corners_;  ///< of facets
  std::vector<Eigen::Vector3d> normals_;  ///< of facets, not of unit length
  std::vector<LocalPoint> points_;
  std::vector<FreePlace> bends_;  ///< of each vertex whose neighbours move: its way from their mean
  std::vector<Index> bent_;       ///< these vertices and those that the move takes away
};

}  // namespace batten
