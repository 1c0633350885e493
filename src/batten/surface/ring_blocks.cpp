#include "batten/surface/ring_blocks.h"

namespace batten {

RingBlocks::RingBlocks(const RingTypes& types, int most_depth) : types_(types) {
  nodes_.resize(static_cast<std::size_t>(types.type_count()) * static_cast<std::size_t>(most_depth));
  for (int depth = 1; depth <= most_depth; ++depth) {
    for (Index type = 0; type < types.type_count(); ++type) {
      const RingTypes::Step& step = types.step(type);
      Node& node = nodes_[node_of(type, depth)];
      node.size = 1 + static_cast<std::size_t>(step.rows.count());
      for (std::size_t c = 0; c < 4; ++c) {
        const Index child = types.child(type, static_cast<int>(c)).type;
        Node::Child& result = node.children[c];
        result = {kPatch, child, 0, step.children[c].data()};
        if (child == RingTypes::kPatch) continue;
        result.node = depth == 1 ? kTreeEnds : node_of(child, depth - 1);
        if (depth == 1) continue;
        result.offset = static_cast<std::uint32_t>(node.size);
        node.size += nodes_[result.node].size;
      }
    }
  }
  jumps_.resize(4 * nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    for (std::size_t c = 0; c < 4; ++c) {
      Jump jump{nodes_[n].children[c], 0, nodes_[n].children[c].offset};
      while (jump.child.type != RingTypes::kPatch) {
        jumps_[4 * n + c].push_back(jump);
        if (jump.child.node < 0) break;
        jump.block = jump.tree;
        jump.child = nodes_[jump.child.node].children[c];
        jump.tree += jump.child.offset;
      }
    }
  }
}

void RingBlocks::centre(Index type, const Double4* points, const Index* rows, Buffer<Double4>& ring) const {
  const auto count = static_cast<std::size_t>(types_.step(type).ring_size);
  ring.resize(count);
  for (std::size_t i = 0; i < count; ++i) ring[i] = points[rows[i]] - points[rows[0]];
}

void RingBlocks::fill(std::int32_t number, const Double4* points, const Index* rows, Double4 origin, Double4* tree,
                      Buffer<Double4>& scratch) const {
  const Node& node = nodes_[number];
  const Index type = number % types_.type_count();
  const SparseRows& rows_of_step = types_.step(type).rows;
  centre(type, points, rows, scratch);
  Double4* block = tree + 1;
  tree[0] = origin + points[rows[0]];
  for (Index r = 0; r < rows_of_step.count(); ++r) block[r] = combine(rows_of_step, r, scratch.data());
  for (const Node::Child& child : node.children) {
    if (child.node >= 0) fill(child.node, block, child.points, tree[0], tree + child.offset, scratch);
  }
}

}  // namespace batten
