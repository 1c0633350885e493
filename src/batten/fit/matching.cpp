#include "batten/fit/matching.h"

#include <queue>

namespace batten {

namespace {

/// A search from one free node for another along which partners change; odd circles are shrunk to their base.
class Matcher {
 public:
  explicit Matcher(Index nodes) : near_(static_cast<std::size_t>(nodes)), partner_(near_.size(), -1) {}

  void add(const MatchedPair& pair) {
    near_[pair.a].push_back(pair.b);
    near_[pair.b].push_back(pair.a);
    if (partner_[pair.a] >= 0 || partner_[pair.b] >= 0) return;
    partner_[pair.a] = pair.b;
    partner_[pair.b] = pair.a;
  }

  /// As many pairs as possible of those added so far; nodes with a partner keep one.
  void match() {
    for (Index node = 0; node < static_cast<Index>(near_.size()); ++node) {
      if (partner_[node] < 0) change_along(search_from(node));
    }
  }

  const std::vector<Index>& partners() const { return partner_; }

 private:
  Index base_of_both(Index a, Index b) const {
    std::vector<bool> on_way(near_.size(), false);
    for (;;) {
      a = base_[a];
      on_way[a] = true;
      if (partner_[a] < 0) break;
      a = parent_[partner_[a]];
    }
    for (;;) {
      b = base_[b];
      if (on_way[b]) return b;
      b = parent_[partner_[b]];
    }
  }

  void mark_way(Index node, Index base, Index child, std::vector<bool>& in_circle) {
    while (base_[node] != base) {
      in_circle[base_[node]] = in_circle[base_[partner_[node]]] = true;
      parent_[node] = child;
      child = partner_[node];
      node = parent_[partner_[node]];
    }
  }

  void shrink(Index a, Index b, std::queue<Index>& waiting) {
    const Index base = base_of_both(a, b);
    std::vector<bool> in_circle(near_.size(), false);
    mark_way(a, base, b, in_circle);
    mark_way(b, base, a, in_circle);
    for (Index node = 0; node < static_cast<Index>(near_.size()); ++node) {
      if (!in_circle[base_[node]]) continue;
      base_[node] = base;
      if (used_[node]) continue;
      used_[node] = true;
      waiting.push(node);
    }
  }

  /// The free node at the end, or -1.
  Index search_from(Index root) {
    used_.assign(near_.size(), false);
    parent_.assign(near_.size(), -1);
    base_.resize(near_.size());
    for (Index node = 0; node < static_cast<Index>(near_.size()); ++node) base_[node] = node;
    used_[root] = true;
    std::queue<Index> waiting;
    waiting.push(root);
    while (!waiting.empty()) {
      const Index from = waiting.front();
      waiting.pop();
      for (const Index to : near_[from]) {
        if (base_[from] == base_[to] || partner_[from] == to) continue;
        if (to == root || (partner_[to] >= 0 && parent_[partner_[to]] >= 0)) {
          shrink(from, to, waiting);
        } else if (parent_[to] < 0) {
          parent_[to] = from;
          if (partner_[to] < 0) return to;
          used_[partner_[to]] = true;
          waiting.push(partner_[to]);
        }
      }
    }
    return -1;
  }

  void change_along(Index end) {
    while (end >= 0) {
      const Index before = parent_[end];
      const Index next = partner_[before];
      partner_[end] = before;
      partner_[before] = end;
      end = next;
    }
  }

  std::vector<std::vector<Index>> near_;
  std::vector<Index> partner_;
  std::vector<bool> used_;
  std::vector<Index> parent_;
  std::vector<Index> base_;
};

}  // namespace

std::vector<Index> maximum_matching(Index nodes, const std::vector<MatchedPair>& pairs,
                                    const std::vector<double>& limits) {
  Matcher matcher(nodes);
  std::size_t next = 0;
  for (const double limit : limits) {
    for (; next < pairs.size() && pairs[next].cost < limit; ++next) matcher.add(pairs[next]);
    matcher.match();
  }
  for (; next < pairs.size(); ++next) matcher.add(pairs[next]);
  matcher.match();
  return matcher.partners();
}

}  // namespace batten
