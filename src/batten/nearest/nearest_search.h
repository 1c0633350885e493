/// \file One search for the nearest point. It visits cells from the nearest on, and leaves each as soon as its bounds
/// prove that it has nothing nearer.
#pragma once
#include <cstdint>
#include <limits>

#include "batten/nearest/surface_cells.h"

namespace batten {

/// What a search has found.
struct NearestFound {
  Index face = 0;
  double u = 0.0;
  double v = 0.0;
  Double4 offset{};      ///< from the query to the point
  double squared = 0.0;  ///< the squared distance
  double least = 0.0;    ///< a squared distance: it is proved that no point is nearer
};

/// Where the squared distance is convex over a cell, Newton's method finds its minimum and proves it: a convex function
/// lies above its tangent plane. Where it is not, the cell is halved. A search is the scratch memory of one thread.
template <typename Net>
class NearestSearch {
 public:
  explicit NearestSearch(const SurfaceCells<Net>& cells);

  /// Leaves out cells in which a point could be nearer by less than the tolerance. any_point: the first point that is
  /// found will do, since none is nearer by more than the caller knows; `least` is then 0.
  NearestFound find(const Double4& query, double tolerance, bool any_point);

 private:
  /// A part of a cell that waits to be halved.
  struct Part {
    Index face;
    Placement placement;
    std::array<Double4, Net::kPoints> net;
  };
  void visit(Index place);
  void search_net(const Double4* net, const Placement& placement);
  void search_pending();
  bool search_border(const Double4* net, const Placement& placement);
  void search_ring(Index type, std::size_t first, const Placement& placement);
  void search_ring_child(const RingTypes::Child& child, std::size_t first, const Placement& placement);
  bool descend(const Double4* net, const NetFrame<Net>& frame, double modulus, const Placement& placement,
               double& least);
  void offer_corners(const Placement& placement);
  bool offer(const Double4& point, double u, double v);
  bool leave(double squared);
  bool leave_box(const Double4* points, std::size_t count);

  const SurfaceCells<Net>& cells_;
  Double4 query_{};
  double tolerance_ = 0.0;
  double cut_ = 0.0;  ///< parts at this squared distance or beyond it are left
  NearestFound best_;
  Index face_ = 0;           ///< of the cell that is being searched
  std::int64_t visits_ = 0;  ///< of cells and parts of cells
  std::int64_t most_visits_;
  typename SurfaceCells<Net>::Scratch scratch_;
  std::vector<Double4> rings_;  ///< a stack of the rings between a cell and the part at hand
  std::vector<Part> pending_;
  std::vector<std::pair<double, std::size_t>> queue_;  ///< a heap of pending parts by their bound on the distance
};

}  // namespace batten
