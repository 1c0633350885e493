/// \file Irregular faces halved beforehand: the control points of their patches, ready for evaluation.
#pragma once
#include <span>
#include <vector>

#include "batten/patch/ring_types.h"
#include "batten/patch/spline_jet.h"

namespace batten {

/// Control points are kept with an origin near them, so that small rings keep their digits: a block is the origin, then
/// the points of a step (patch/ring_types.h) as seen from there.
///
/// The tree of a ring `depth` halvings deep is the block of its children, then the trees of those of its children that
/// are rings, one halving less deep.
class RingBlocks {
 public:
  /// The types must outlive it.
  RingBlocks(const RingTypes& types, int most_depth);

  /// A ring from which a tree of some depth starts.
  struct Node {
    struct Child {
      std::int32_t node;     ///< of a ring, or kPatch; kTreeEnds where the child's own tree is not kept
      std::int32_t type;     ///< of ring, or RingTypes::kPatch
      std::uint32_t offset;  ///< of its tree in this one
      const Index* points;   ///< of its ring or patch, in this tree's block
    };
    std::array<Child, 4> children;
    std::size_t size;  ///< of the tree
  };
  /// Several halvings to the child at the same corner.
  struct Jump {
    Node::Child child;    ///< the last one
    std::uint32_t block;  ///< that its points are in, from the start of the first node's tree
    std::uint32_t tree;   ///< where its own tree starts
  };
  static constexpr std::int32_t kPatch = -1;
  static constexpr std::int32_t kTreeEnds = -2;

  /// depth >= 1.
  std::int32_t node_of(Index type, int depth) const { return (depth - 1) * types_.type_count() + type; }
  const Node& node(std::int32_t number) const { return nodes_[number]; }

  /// One jump for each number of halvings to rings, 1 and more.
  std::span<const Jump> jumps(std::int32_t node, int corner) const { return jumps_[4 * node + corner]; }

  /// Fills the tree of a ring of control points rows[i] of `points`, seen from `origin`.
  void fill(std::int32_t node, const Double4* points, const Index* rows, Double4 origin, Double4* tree,
            Buffer<Double4>& scratch) const;

 private:
  /// The ring as seen from its first point.
  void centre(Index type, const Double4* points, const Index* rows, Buffer<Double4>& ring) const;

  const RingTypes& types_;
  Buffer<Node> nodes_;
  std::vector<std::vector<Jump>> jumps_;  ///< of each node, four
};

}  // namespace batten
