#include "batten/io/crease_chains.h"

#include <algorithm>
#include <tuple>

namespace batten::io {

namespace {

/// An edge seen from one of its ends.
struct Spoke {
  double sharpness;
  Index from;
  Index to;
  bool used = false;
};

auto key(const Spoke& spoke) { return std::make_tuple(spoke.sharpness, spoke.from, spoke.to); }

/// Both spokes of every edge, sorted by sharpness and vertex. The last of several equal edges is kept.
std::vector<Spoke> sorted_spokes(const std::vector<Crease>& creases) {
  std::vector<Spoke> edges;
  edges.reserve(creases.size());
  for (const Crease& crease : creases) {
    const double sharpness = std::min(crease.sharpness, double{kInfiniteSharpness});
    edges.push_back({sharpness, std::min(crease.a, crease.b), std::max(crease.a, crease.b)});
  }
  const auto ends = [](const Spoke& edge) { return std::make_pair(edge.from, edge.to); };
  std::stable_sort(edges.begin(), edges.end(), [&](const Spoke& a, const Spoke& b) { return ends(a) < ends(b); });
  std::vector<Spoke> spokes;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool last = i + 1 == edges.size() || ends(edges[i]) != ends(edges[i + 1]);
    if (!last || !(edges[i].sharpness > 0.0)) continue;
    spokes.push_back(edges[i]);
    spokes.push_back({edges[i].sharpness, edges[i].to, edges[i].from});
  }
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) { return key(a) < key(b); });
  return spokes;
}

class ChainWalk {
 public:
  explicit ChainWalk(const std::vector<Crease>& creases) : spokes_(sorted_spokes(creases)) {}

  std::vector<CreaseChain> walk() {
    std::vector<CreaseChain> chains;
    for (const bool ends_only : {true, false}) {
      for (std::size_t i = 0; i < spokes_.size(); ++i) {
        if (spokes_[i].used || (ends_only && at(spokes_[i].sharpness, spokes_[i].from).count == 2)) continue;
        chains.push_back(chain_from(i));
      }
    }
    return chains;
  }

 private:
  struct Range {
    std::size_t first;
    std::size_t count;
  };

  /// The spokes of this sharpness at a vertex.
  Range at(double sharpness, Index vertex) const {
    const auto before = [](const Spoke& a, const Spoke& b) {
      return std::make_pair(a.sharpness, a.from) < std::make_pair(b.sharpness, b.from);
    };
    const auto range = std::equal_range(spokes_.begin(), spokes_.end(), Spoke{sharpness, vertex, 0}, before);
    return {static_cast<std::size_t>(range.first - spokes_.begin()),
            static_cast<std::size_t>(range.second - range.first)};
  }

  void use(std::size_t i) {
    spokes_[i].used = true;
    const Range back = at(spokes_[i].sharpness, spokes_[i].to);
    for (std::size_t k = back.first; k < back.first + back.count; ++k) {
      if (spokes_[k].to == spokes_[i].from) spokes_[k].used = true;
    }
  }

  CreaseChain chain_from(std::size_t i) {
    CreaseChain chain{{spokes_[i].from}, spokes_[i].sharpness};
    for (;;) {
      use(i);
      chain.vertices.push_back(spokes_[i].to);
      const Range next = at(chain.sharpness, spokes_[i].to);
      if (next.count != 2) return chain;
      i = spokes_[next.first].used ? next.first + 1 : next.first;
      if (spokes_[i].used) return chain;
    }
  }

  std::vector<Spoke> spokes_;
};

}  // namespace

std::vector<CreaseChain> crease_chains(const std::vector<Crease>& creases) { return ChainWalk(creases).walk(); }

}  // namespace batten::io
