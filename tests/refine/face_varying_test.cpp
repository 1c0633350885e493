#include "batten/refine/face_varying.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr FaceVaryingRule kSmoothRules[] = {FaceVaryingRule::None, FaceVaryingRule::CornersOnly,
                                            FaceVaryingRule::CornersPlus1, FaceVaryingRule::CornersPlus2,
                                            FaceVaryingRule::Boundaries};

Scheme with_rule(FaceVaryingRule rule, SchemeKind kind = SchemeKind::CatmullClark) {
  Scheme scheme;
  scheme.kind = kind;
  scheme.face_varying = rule;
  return scheme;
}

/// The unit square on every face, each with rows of its own.
Attribute squares(const Mesh& mesh) {
  Attribute uv{"uv", Values(static_cast<Eigen::Index>(mesh.face_vertices.size()), 2), {}};
  for (Index c = 0; c < static_cast<Index>(uv.values.rows()); ++c) {
    uv.values.row(c) << (c % 4 == 1 || c % 4 == 2 ? 1.0 : 0.0), (c % 4 > 1 ? 1.0 : 0.0);
    uv.corner_rows.push_back(c);
  }
  return uv;
}

/// A row a vertex, and beside the edges from `a` to `b` another row a vertex on one side: one seam of a torus.
Attribute with_a_slit(const Mesh& mesh, const std::vector<Index>& path, const std::vector<Index>& faces) {
  Attribute uv{"uv", Values::Random(mesh.vertex_count() + static_cast<Eigen::Index>(path.size()), 2),
               mesh.face_vertices};
  for (const Index f : faces) {
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) {
      for (std::size_t i = 0; i < path.size(); ++i) {
        if (mesh.face_vertices[c] == path[i]) uv.corner_rows[c] = mesh.vertex_count() + static_cast<Index>(i);
      }
    }
  }
  return uv;
}

TEST(FaceVarying, WithoutASeamAClosedMeshCarriesThemAsItCarriesPoints) {
  const Mesh mesh = torus(7, 5);
  const Topology topology(mesh);
  const Attribute uv{"uv", mesh.points.leftCols(2), mesh.face_vertices};
  for (const FaceVaryingRule rule : kSmoothRules) {
    const FaceVaryingSurface surface = face_varying_surface(topology, with_rule(rule), uv);
    EXPECT_EQ(surface.topology.vertex_count(), topology.vertex_count());
    EXPECT_EQ(surface.refined().values, Refinement(topology, {}).apply(mesh.points).leftCols(2));
    EXPECT_EQ(surface.attribute("uv").corner_rows, uv.corner_rows);
  }
}

TEST(FaceVarying, ACornerMovesUnderNoneOnly) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  for (const FaceVaryingRule rule : kSmoothRules) {
    const Attribute refined = refine_at_corners(topology, with_rule(rule), squares(mesh));
    // Of each child the first corner is the parent's.
    const Eigen::RowVector2d corner = refined.values.row(refined.corner_rows[0]);
    const Eigen::RowVector2d expected =
        rule == FaceVaryingRule::None ? Eigen::RowVector2d(0.125, 0.125) : Eigen::RowVector2d(0.0, 0.0);
    EXPECT_EQ(corner, expected) << static_cast<int>(rule);
    EXPECT_EQ(refined.values.row(refined.corner_rows[1]), Eigen::RowVector2d(0.5, 0.0));
    EXPECT_EQ(refined.values.row(refined.corner_rows[2]), Eigen::RowVector2d(0.5, 0.5));
  }
}

TEST(FaceVarying, TheEndOfASeamStaysUnderPlus2AndBoundaries) {
  const Mesh mesh = torus(8, 6);
  const Topology topology(mesh);
  // The seam is the edge (a, b): its face has a row of its own at b, beside that of all others.
  const Index a = mesh.face_vertices[0];
  const Index b = mesh.face_vertices[1];
  const Attribute uv = with_a_slit(mesh, {b}, {0});
  for (const FaceVaryingRule rule : kSmoothRules) {
    const FaceVaryingSurface surface = face_varying_surface(topology, with_rule(rule), uv);
    const bool stays = rule == FaceVaryingRule::CornersPlus2 || rule == FaceVaryingRule::Boundaries;
    EXPECT_TRUE(surface.topology.is_boundary_vertex(a));
    EXPECT_EQ(surface.refined().values.row(a) == uv.values.row(a), stays) << static_cast<int>(rule);
  }
}

TEST(FaceVarying, ThreePiecesMakeACornerFromPlus1On) {
  const Mesh mesh = grid(4, 4);
  const Topology topology(mesh);
  const Index middle = 2 * 5 + 2;
  // Two faces at the middle have rows of their own, the other two share the vertices' rows: pieces of one face, one
  // face and two faces.
  Attribute uv{"uv", Values::Random(mesh.vertex_count() + 8, 2), mesh.face_vertices};
  Index next = mesh.vertex_count();
  for (const Index f : {5, 6}) {
    for (Index c = 4 * f; c < 4 * f + 4; ++c) uv.corner_rows[c] = next++;
  }
  for (const FaceVaryingRule rule : kSmoothRules) {
    const FaceVaryingSurface surface = face_varying_surface(topology, with_rule(rule), uv);
    const bool stays = rule != FaceVaryingRule::None && rule != FaceVaryingRule::CornersOnly;
    EXPECT_EQ(surface.refined().values.row(middle) == uv.values.row(middle), stays) << static_cast<int>(rule);
  }
}

TEST(FaceVarying, AValueThatComesBackIsACorner) {
  const Mesh mesh = grid(2, 2);
  // By turns two values around the middle vertex, 4.
  Attribute uv{"uv", Values::Random(17, 2), Buffer<Index>(16)};
  for (Index c = 0; c < 16; ++c) {
    const bool middle = mesh.face_vertices[c] == 4;
    const bool diagonal = c / 4 == 0 || c / 4 == 3;
    uv.corner_rows[c] = !middle ? c : diagonal ? 2 : 16;
  }
  for (const FaceVaryingRule rule : kSmoothRules) {
    const Attribute refined = refine_at_corners(Topology(mesh), with_rule(rule), uv);
    for (Index c = 0; c < 16; ++c) {
      if (mesh.face_vertices[c] != 4) continue;
      EXPECT_EQ(refined.values.row(refined.corner_rows[4 * c]), uv.values.row(uv.corner_rows[c]));
    }
  }
}

TEST(FaceVarying, BoundariesAreLinear) {
  const Mesh mesh = grid(3, 2);
  const Topology topology(mesh);
  const Attribute uv{"uv", Values::Random(mesh.vertex_count(), 2), mesh.face_vertices};
  FaceVaryingSurface surface = face_varying_surface(topology, with_rule(FaceVaryingRule::Boundaries), uv);
  for (int level = 0; level < 3; ++level) surface = surface.refined();
  const Values limit = LimitMatrix(surface.topology, surface.scheme).apply(surface.values);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const bool boundary = topology.is_boundary_vertex(v);
    EXPECT_EQ((limit.row(v) - uv.values.row(v)).norm() < 1e-15, boundary) << v;
  }
}

TEST(FaceVarying, RowsThatServeSeveralPlacesAreTakenApart) {
  Mesh mesh = grid(2, 1);
  // Both faces have the same texture: no edge is shared.
  const Attribute uv{"uv", (Values(4, 2) << 0, 0, 1, 0, 1, 1, 0, 1).finished(), {0, 1, 2, 3, 0, 1, 2, 3}};
  const FaceVaryingSurface surface = face_varying_surface(Topology(mesh), with_rule(FaceVaryingRule::CornersOnly), uv);
  EXPECT_EQ(surface.topology.vertex_count(), 8);
  EXPECT_EQ(surface.topology.edge_count(), 8);
  const Attribute apart = surface.attribute("uv");
  for (Index c = 0; c < 8; ++c) EXPECT_EQ(apart.values.row(apart.corner_rows[c]), uv.values.row(c % 4));
}

TEST(FaceVarying, AFaceWithACornerWithoutARowHasNone) {
  const Mesh mesh = grid(3, 1);
  Attribute uv{"uv", mesh.points.leftCols(2), mesh.face_vertices};
  uv.corner_rows[5] = -1;
  for (const FaceVaryingRule rule : kSmoothRules) {
    const Mesh control = [&] {
      Mesh given = mesh;
      given.attributes = {uv};
      return given;
    }();
    const RefinedMesh refined = refine_mesh(Topology(mesh), with_rule(rule), control, 2);
    const Attribute& fine = refined.mesh.attributes[0];
    EXPECT_TRUE(fine.values.allFinite());
    for (Index c = 0; c < static_cast<Index>(fine.corner_rows.size()); ++c) {
      ASSERT_EQ(fine.corner_rows[c] < 0, c / 64 == 1) << c;  // 16 quads a face
    }
  }
}

TEST(FaceVarying, RowsThatDoNotFitAreRefused) {
  const Mesh mesh = grid(2, 1);
  const Topology topology(mesh);
  const auto expect_refused = [&](const Attribute& uv, ErrorCode code, const std::string& message) {
    try {
      face_varying_surface(topology, with_rule(FaceVaryingRule::None), uv);
      FAIL() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_STREQ(error.what(), message.c_str());
    }
  };
  Attribute uv = squares(mesh);
  uv.corner_rows[6] = 8;
  expect_refused(uv, ErrorCode::IndexOutOfRange, "face 1 has row 8 of attribute 'uv', which has 8 rows");
  uv.corner_rows.pop_back();
  expect_refused(uv, ErrorCode::BadShape, "attribute 'uv' must have one row number per corner");
  uv = squares(mesh);
  uv.values(3, 1) = std::nan("");
  expect_refused(uv, ErrorCode::NotFinite, "row 3 of the attribute 'uv' is not finite");
}

/// What a program makes of the refined mesh, which says its rule, is what it makes of the mesh given.
TEST(FaceVarying, ARefinedMeshHasTheSameTexture) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    Mesh mesh = test::with_random_tags(sample.mesh, 3);
    Buffer<Index> rows = mesh.face_vertices;
    for (std::size_t c = 0; c < rows.size(); c += 3) rows[c] = mesh.vertex_count() + static_cast<Index>(c);
    mesh.attributes = {{"uv", Values::Random(mesh.vertex_count() + static_cast<Eigen::Index>(rows.size()), 2), rows}};
    for (const FaceVaryingRule rule : kSmoothRules) {
      SCOPED_TRACE(sample.name + ", rule " + std::to_string(static_cast<int>(rule)));
      const Scheme scheme = with_rule(rule);
      const Mesh once = refine_mesh(Topology(mesh), scheme, mesh, 1).mesh;
      EXPECT_EQ(once.face_varying, rule);
      const Mesh again = refine_mesh(Topology(once), choose_scheme(once), once, 1).mesh;
      const Mesh twice = refine_mesh(Topology(mesh), scheme, mesh, 2).mesh;
      const Attribute& a = again.attributes[0];
      const Attribute& b = twice.attributes[0];
      const Values difference = a.values(a.corner_rows, Eigen::all) - b.values(b.corner_rows, Eigen::all);
      // Sharpness is a float, and its fraction is a weight.
      EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace batten
