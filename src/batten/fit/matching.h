/// \file Partners in a graph.
#pragma once
#include <vector>

#include "batten/types.h"

namespace batten {

/// Two nodes that may become partners; less cost is better.
struct MatchedPair {
  double cost;
  Index a;
  Index b;
  bool operator<(const MatchedPair& other) const {
    if (cost != other.cost) return cost < other.cost;
    return a != other.a ? a < other.a : b < other.b;
  }
};

/// The partner of each node, or -1: as many pairs as possible (Edmonds 1965, key E65). As many as possible cost less
/// than the first limit, of the others as many as possible less than the second, and so on; within that the cheapest
/// are taken first. `pairs` come in order. O(limits * nodes * pairs) at worst.
std::vector<Index> maximum_matching(Index nodes, const std::vector<MatchedPair>& pairs,
                                    const std::vector<double>& limits);

}  // namespace batten
