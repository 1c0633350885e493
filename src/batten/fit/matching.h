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

/// The partner of each node, or -1: as many pairs as possible (Edmonds 1965, key Edm65). `pairs` come in order: those
/// whose nodes are free are taken first. O(nodes * pairs) at worst.
std::vector<Index> maximum_matching(Index nodes, const std::vector<MatchedPair>& pairs);

}  // namespace batten
