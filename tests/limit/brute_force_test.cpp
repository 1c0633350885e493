#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/refine/vertex_blend.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Hundreds of terms of order 1, three levels.
constexpr double kTolerance = 1e-12;

double worst_row(ConstValuesRef a, ConstValuesRef b) { return (a - b).rowwise().norm().maxCoeff(); }

std::vector<Mesh> tagged_variants(const Mesh& mesh) {
  std::vector<Mesh> variants{mesh};
  for (unsigned seed = 1; seed <= 3; ++seed) variants.push_back(test::with_random_tags(mesh, seed));
  return variants;
}

/// A P is the same from every level, for every tag, dart, fading crease and valence of the samples.
TEST(LimitByRefinement, IsTheSameFromEveryLevel) {
  test::for_each_sample([](const Mesh& plain, Scheme scheme, const std::string& name) {
    for (const Mesh& mesh : tagged_variants(plain)) {
      for (const auto method : {CreaseMethod::Uniform, CreaseMethod::Chaikin}) {
        scheme.crease_method = method;
        const Topology topology(mesh);
        const Values limit = LimitMatrix(topology, scheme).apply(mesh.points);
        for (int level = 1; level <= 3; ++level) {
          const RefinedSurface fine = refine(topology, scheme, mesh.points, level);
          const Values same = LimitMatrix(fine.topology, scheme).apply(fine.values).topRows(mesh.vertex_count());
          EXPECT_LT(worst_row(same, limit), kTolerance) << name << ", level " << level;
        }
      }
    }
  });
}

TEST(LimitByRefinement, IsTheSameFromEveryLevelWithAlphaAndSmoothTriangles) {
  test::for_each_sample([](const Mesh& mesh, Scheme scheme, const std::string& name) {
    if (scheme.kind == SchemeKind::Loop) return;
    for (const double alpha : {0.0, 0.5}) {
      scheme.alpha = alpha;
      scheme.triangle_rule = TriangleRule::Smooth;
      const Topology topology(mesh);
      const Values limit = LimitMatrix(topology, scheme).apply(mesh.points);
      const RefinedSurface fine = refine(topology, scheme, mesh.points, 2);
      const Values same =
          LimitMatrix(fine.topology, scheme.after_first_step()).apply(fine.values).topRows(mesh.vertex_count());
      EXPECT_LT(worst_row(same, limit), kTolerance) << name << ", alpha " << alpha;
    }
  });
}

/// The vertices themselves come closer by less than 0.7 a level (lambda < 0.655 for every valence; tags of 4 and less
/// have faded at level 4). An arbitrary fixed mask would not have this limit.
TEST(LimitByRefinement, IsWhereTheVerticesGo) {
  test::for_each_sample([](const Mesh& plain, const Scheme& scheme, const std::string& name) {
    if (plain.face_count() > 30) return;
    for (const Mesh& mesh : tagged_variants(plain)) {
      const Topology topology(mesh);
      const Values limit = LimitMatrix(topology, scheme).apply(mesh.points);
      const auto distance = [&](int level) {
        const RefinedSurface fine = refine(topology, scheme, mesh.points, level);
        return worst_row(fine.values.topRows(mesh.vertex_count()), limit);
      };
      const double at_four = distance(4);
      EXPECT_LT(at_four, 0.3) << name;
      EXPECT_LT(distance(6), 0.7 * 0.7 * at_four + 1e-15) << name;
    }
  });
}

TEST(LimitByRefinement, MatrixAndRowsAndApplicationAgree) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const Topology topology(test::with_random_tags(mesh, 2));
    const LimitMatrix limit(topology, scheme);
    const Values applied = limit.apply(mesh.points);
    EXPECT_LT(worst_row(limit.matrix() * mesh.points, applied), 1e-14) << name;
    EXPECT_LT(worst_row(limit.matrix() * Values::Ones(mesh.vertex_count(), 1), Values::Ones(mesh.vertex_count(), 1)),
              1e-14)
        << name;
  });
}

/// Where the exact tangents exist: everywhere but at creases and boundaries of more faces than the bound
/// (docs/mathematics.md, Limit tangents), and at interior vertices of valence 2.
bool has_exact_tangents(const Topology& topology, const Scheme& scheme, Index vertex) {
  VertexRing ring;
  if (topology.is_isolated(vertex)) return false;
  const VertexRule rule = vertex_rule_of(topology, scheme, vertex, ring);
  if (rule == VertexRule::Corner) return topology.is_boundary_vertex(vertex) && ring.corners.size() == 1;
  if (ring.corners.size() <= 2 && ring.closed) return false;
  const std::size_t bound = scheme.kind == SchemeKind::CatmullClark ? 3 : 5;
  return rule != VertexRule::Crease || (ring.corners.size() > 1 && ring.corners.size() <= bound);
}

/// The largest sine between an original vertex's normal and its edges after `level` steps. Edges turn into the tangent
/// plane by the ratio of the third eigenvalue to the second a level; only valences up to 6 are tested, where it is 0.71
/// or less.
double worst_slope(const Topology& topology, const Scheme& scheme, const Mesh& mesh, const Values& normals, int level) {
  const RefinedSurface fine = refine(topology, scheme, mesh.points, level);
  double worst = 0.0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!has_exact_tangents(topology, scheme, v) || topology.vertex_face_count(v) > 6) continue;
    fine.topology.for_each_outgoing(v, [&](Index h) {
      const Eigen::RowVector3d edge = fine.values.row(fine.topology.destination(h)) - fine.values.row(v);
      worst = std::max(worst, std::abs(edge.normalized().dot(normals.row(v).head<3>())));
    });
  }
  return worst;
}

TEST(LimitByRefinement, NormalsAreOrthogonalToTheEdgesInTheLimit) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    if (mesh.face_count() > 40) return;
    const Topology topology(mesh);
    const Values normals = limit_normals(topology, scheme, mesh.points).vertices;
    const double at_two = worst_slope(topology, scheme, mesh, normals, 2);
    const double at_six = worst_slope(topology, scheme, mesh, normals, 6);
    EXPECT_LT(at_six, 0.3 * at_two + 1e-12) << name;
  });
}

/// Normals pulled back through fading tags are those of the surface once they have faded.
void expect_same_normals(const Mesh& mesh, const Scheme& scheme, bool darts, const std::string& name) {
  const Topology topology(mesh);
  const Values normals = limit_normals(topology, scheme, mesh.points).vertices;
  const RefinedSurface fine = refine(topology, scheme, mesh.points, 4);
  const Values same = limit_normals(fine.topology, scheme, fine.values).vertices;
  VertexRing ring;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!has_exact_tangents(fine.topology, scheme, v)) continue;
    if (darts != (vertex_rule_of(fine.topology, scheme, v, ring) == VertexRule::Dart)) continue;
    EXPECT_LT((same.row(v) - normals.row(v)).norm(), 1e-9) << name << ", vertex " << v;
  }
}

TEST(LimitByRefinement, NormalsAreTheSameFromEveryLevel) {
  test::for_each_sample([](const Mesh& plain, const Scheme& scheme, const std::string& name) {
    for (Mesh mesh : tagged_variants(plain)) {
      mesh.corners.clear();
      expect_same_normals(mesh, scheme, false, name);
    }
  });
}

/// Rounding must not let the odd eigenvector into ring_limit's power iteration, which would turn the normals of darts.
TEST(LimitByRefinement, NormalsAtDartsAreTheSameFromEveryLevel) {
  test::for_each_sample([](const Mesh& plain, const Scheme& scheme, const std::string& name) {
    for (Mesh mesh : tagged_variants(plain)) {
      mesh.corners.clear();
      expect_same_normals(mesh, scheme, true, name);
    }
  });
}

/// A single infinitely sharp edge, in every place of a ring of quads or triangles.
TEST(LimitByRefinement, NormalsAtDartsAreOrthogonalToTheEdgesInTheLimit) {
  for (const Mesh& solid : {cube(), icosahedron(), octahedron()}) {
    for (Index side = 0; side < solid.face_offsets[1]; ++side) {
      Mesh mesh = test::jittered(solid, 0.1, 3);
      mesh.creases = {{mesh.face_vertices[side], mesh.face_vertices[(side + 1) % mesh.face_size(0)], 10.0}};
      const Topology topology(mesh);
      const Scheme scheme;
      const Values normals = limit_normals(topology, scheme, mesh.points).vertices;
      EXPECT_LT(worst_slope(topology, scheme, mesh, normals, 6), 0.5 * worst_slope(topology, scheme, mesh, normals, 2));
    }
  }
}

}  // namespace
}  // namespace batten
