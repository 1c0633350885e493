#include "batten/fit/surface_guard.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/mesh/primitives.h"
#include "batten/patch/surface_patches.h"
#include "fit/clouds.h"

namespace batten {
namespace {

Index count_of(const Buffer<std::uint8_t>& flags) {
  return static_cast<Index>(std::count(flags.begin(), flags.end(), 1));
}

TEST(SurfaceGuard, FindsNothingInASoundSurface) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const Mesh mesh = kind == SchemeKind::Loop ? octahedron() : torus(12, 6);
    const SurfacePatches patches(Topology(mesh), {kind});
    const Buffer<std::uint8_t> flags = SurfaceGuard(patches).unsound(mesh.points, Soundness::Whole);
    EXPECT_EQ(static_cast<Index>(flags.size()), mesh.face_count());
    EXPECT_EQ(count_of(flags), 0);
  }
}

/// A vertex of a flat grid, pulled across its neighbour: faces around it overlap upside down.
TEST(SurfaceGuard, FindsAFold) {
  Mesh mesh = grid(6, 6);
  const Index middle = 24;
  mesh.points(middle, 0) += 1.5;
  const SurfaceGuard guard(SurfacePatches(Topology(mesh), Scheme{}));
  const Buffer<std::uint8_t> flags = guard.unsound(mesh.points, Soundness::Unfolded);
  EXPECT_GT(count_of(flags), 0);
  EXPECT_LE(count_of(flags), 16) << "no face is far from the vertex";
}

/// Two flat grids of two by two units that cross at right angles.
TEST(SurfaceGuard, FindsWhereASurfacePassesThroughItself) {
  Mesh one = grid(4, 4);
  Mesh other = one;
  other.points.col(1).swap(other.points.col(2));
  other.points.rowwise() += Eigen::RowVector3d(0.11, 0.07, 0.03);
  Mesh both = one;
  both.points.conservativeResize(50, 3);
  both.points.bottomRows(25) = other.points;
  for (const Index v : other.face_vertices) both.face_vertices.push_back(v + 25);
  for (Index f = 1; f <= 16; ++f) both.face_offsets.push_back(both.face_offsets[16] + 4 * f);
  const SurfaceGuard guard(SurfacePatches(Topology(both), Scheme{}));
  EXPECT_EQ(count_of(guard.unsound(both.points, Soundness::Unfolded)), 0);
  const Buffer<std::uint8_t> flags = guard.unsound(both.points, Soundness::Whole);
  EXPECT_GE(count_of(flags), 8) << "two rows of four faces cross";
  EXPECT_LE(count_of(flags), 16);
}

}  // namespace
}  // namespace batten
