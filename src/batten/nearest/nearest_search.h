/// \file One search for the nearest point: cells from the nearest on, each left as soon as its bounds say that it has
/// nothing nearer.
#pragma once
#include <limits>

#include "batten/nearest/surface_cells.h"

namespace batten {

struct NearestFound {
  Index face = 0;
  double u = 0.0;
  double v = 0.0;
  Double4 offset{};      ///< from the query to the point
  double squared = 0.0;  ///< distance
  double least = 0.0;    ///< no point is nearer than this, squared
};

/// Where the squared distance is convex over a cell, Newton's method finds its least and proves it: a convex function
/// lies above its tangent. Where it is not, the cell is halved. Scratch memory of one thread.
template <typename Net>
class NearestSearch {
 public:
  explicit NearestSearch(const SurfaceCells<Net>& cells);

  /// Cells that can win less than the tolerance are left out.
  NearestFound find(const Double4& query, double tolerance);

 private:
  struct Part {
    Index face;
    Placement placement;
    std::array<Double4, Net::kPoints> net;
  };
  void visit(Index place);
  void search_net(const Double4* net, const Placement& placement);
  void search_pending();
  bool search_border(const Double4* net, const Placement& placement);
  void search_ring(Index kind, std::size_t first, const Placement& placement);
  void search_ring_child(const RingSteps::Child& child, std::size_t first, const Placement& placement);
  bool descend(const Double4* net, const NetFrame<Net>& frame, double modulus, const Placement& placement,
               double& least);
  void offer_corners(const Placement& placement);
  bool offer(const Double4& point, double u, double v);
  bool leave(double squared);
  bool leave_box(const Double4* points, std::size_t count);

  const SurfaceCells<Net>& cells_;
  Double4 query_{};
  double tolerance_ = 0.0;
  double cut_ = 0.0;  ///< squared distances from here on are of no interest
  NearestFound best_;
  Index face_ = 0;  ///< of the cell at hand
  int visits_ = 0;
  ///< of cells and parts of cells
  std::vector<Double4> scratch_;
  std::vector<Double4> rings_;  ///< a stack
  std::vector<Part> pending_;
  std::vector<std::pair<double, std::size_t>> queue_;  ///< a heap of pending parts by their least squared distance
};

}  // namespace batten
