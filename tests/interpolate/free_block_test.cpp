#include "batten/interpolate/free_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"

namespace batten {
namespace {

/// What a key promises: equal weights in equal order, the diagonal's last and nowhere else, and the columns before it.
/// Returns how many keys there are.
std::size_t expect_keys_hold(const Topology& topology, const Scheme& scheme, const std::vector<double>& alpha = {}) {
  const LimitMatrix matrix(topology, scheme, {LimitMasks::Exact, alpha});
  const FreeBlock block(matrix, {});
  std::map<Index, std::vector<double>> weights_of_key;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    const Index key = block.weights_key(v);
    if (key == 0) continue;
    RowEntries entries;
    block.row(v, entries);
    const std::vector<double> weights(entries.weights.begin(), entries.weights.end());
    EXPECT_EQ(weights_of_key.emplace(key, weights).first->second, weights) << "vertex " << v;
    const Buffer<Index> off_diagonal(entries.columns.begin(), entries.columns.end() - 1);
    EXPECT_EQ(std::count(off_diagonal.begin(), off_diagonal.end(), v), 0);
    EXPECT_EQ(entries.columns.back(), v);
    Buffer<Index> columns(off_diagonal.size());
    block.columns_of(v, columns.data());
    EXPECT_TRUE(columns == off_diagonal) << "vertex " << v;
  }
  return weights_of_key.size();
}

/// A cube refined twice: valences 3 and 4.
Topology refined_cube() {
  const Mesh mesh = cube();
  return refine(Topology(mesh), Scheme(), mesh.points, 2).topology;
}

TEST(FreeBlock, GivesTheColumnsOfQuadRingsByValence) { EXPECT_EQ(expect_keys_hold(refined_cube(), Scheme()), 2U); }

TEST(FreeBlock, TellsTheAlphasOfQuadRingsApart) {
  const Topology topology = refined_cube();
  std::vector<double> alpha(static_cast<std::size_t>(topology.vertex_count()), 0.0);
  for (std::size_t v = 0; v < alpha.size(); v += 3) alpha[v] = kValenceTwoAlpha;
  for (std::size_t v = 1; v < alpha.size(); v += 3) alpha[v] = 0.25;
  EXPECT_EQ(expect_keys_hold(topology, Scheme(), alpha), 4U);
}

TEST(FreeBlock, GivesTheColumnsOfTriangleRingsByValence) {
  Scheme loop;
  loop.kind = SchemeKind::Loop;
  const Mesh mesh = icosahedron();
  EXPECT_EQ(expect_keys_hold(refine(Topology(mesh), loop, mesh.points, 1).topology, loop), 2U);
}

TEST(FreeBlock, KnowsNoKeysAmongOtherFaces) { EXPECT_EQ(expect_keys_hold(Topology(icosahedron()), Scheme()), 0U); }

/// At the rim of a grid rows have the curve's weights, and no key.
TEST(FreeBlock, KnowsNoKeyAtABoundary) {
  const Topology topology(grid(6, 5));
  const LimitMatrix matrix(topology, Scheme());
  const FreeBlock block(matrix, {});
  for (Index v = 0; v < topology.vertex_count(); ++v)
    EXPECT_EQ(block.weights_key(v), topology.is_boundary_vertex(v) ? 0 : 4);
}

}  // namespace
}  // namespace batten
