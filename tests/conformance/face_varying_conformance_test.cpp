#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/refine/face_varying.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/vertex_blend.h"
#include "conformance/conformance_data.h"
#include "conformance/opensubdiv_oracle.h"
#include "support/shapes.h"

namespace batten::test {
namespace {

/// Both sides sum the same weights in double, in another order; relative to the greatest value.
constexpr double kCornerTolerance = 1e-14;
/// OpenSubdiv's limits along seams and boundaries have weights of single precision.
constexpr double kSeamLimitTolerance = 1e-7;

constexpr FaceVaryingRule kRules[] = {FaceVaryingRule::None,         FaceVaryingRule::CornersOnly,
                                      FaceVaryingRule::CornersPlus1, FaceVaryingRule::CornersPlus2,
                                      FaceVaryingRule::Boundaries,   FaceVaryingRule::All};

const Attribute* texture_coordinates(const Mesh& mesh) {
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [](const Attribute& attribute) {
    return attribute.name == "uv" && attribute.per_corner();
  });
  return found == mesh.attributes.end() ? nullptr : &*found;
}

/// The values at the corners, in the order of the half-edges.
Values at_half_edges(const Attribute& attribute) { return attribute.values(attribute.corner_rows, Eigen::all); }

double worst_corner(const Values& ours, const Values& theirs) {
  return (ours - theirs.leftCols(ours.cols())).cwiseAbs().maxCoeff();
}

/// A mesh whose only attribute is at corners.
Mesh with_corners(Mesh mesh, const Attribute& attribute) {
  mesh.attributes = {attribute};
  return mesh;
}

/// A copy of the row for each time that a value comes back at a vertex beyond a seam. OpenSubdiv makes both corners,
/// but where the second of the values around a vertex comes back it takes it for a third one.
Mesh without_returning_values(Mesh mesh) {
  const Topology topology(mesh);
  Attribute& uv = mesh.attributes[0];
  const Buffer<Index> rows = uv.corner_rows;
  const auto is_seam = [&](Index h) {
    const Index twin = topology.twin(h);
    return twin < 0 || rows[h] != rows[topology.next(twin)] || rows[topology.next(h)] != rows[twin];
  };
  std::vector<Index> copies;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    std::vector<Index> around;
    topology.for_each_outgoing(v, [&](Index h) { around.push_back(h); });
    const auto first = std::find_if(around.begin(), around.end(), is_seam);
    if (first == around.end()) continue;
    std::rotate(around.begin(), first, around.end());
    std::vector<Index> met;
    Index copy = -1;
    for (const Index h : around) {
      if (is_seam(h)) {
        const bool returns = std::find(met.begin(), met.end(), rows[h]) != met.end();
        copy = returns ? static_cast<Index>(uv.values.rows() + static_cast<Eigen::Index>(copies.size())) : -1;
        if (returns) copies.push_back(rows[h]);
        met.push_back(rows[h]);
      }
      if (copy >= 0) uv.corner_rows[h] = copy;
    }
  }
  Values values(uv.values.rows() + static_cast<Eigen::Index>(copies.size()), uv.values.cols());
  values << uv.values, uv.values(copies, Eigen::all);
  uv.values = std::move(values);
  return mesh;
}

void expect_same_corners(Mesh mesh, const Scheme& scheme, int levels) {
  if (scheme.face_varying == FaceVaryingRule::None) mesh = without_returning_values(std::move(mesh));
  const Attribute& given = mesh.attributes[0];
  const Oracle oracle(mesh, scheme, levels, &given);
  const double tolerance = kCornerTolerance * std::max(1.0, given.values.cwiseAbs().maxCoeff());
  for (int level = 1; level <= levels; ++level) {
    const RefinedMesh refined = refine_mesh(oracle.topology(0), scheme, mesh, level);
    EXPECT_LE(worst_corner(at_half_edges(refined.mesh.attributes[0]), oracle.corner_values(level)), tolerance)
        << "level " << level;
  }
}

bool fades_at(const Topology& topology, Index vertex) {
  VertexRing ring;
  gather_ring(topology, vertex, ring);
  return is_semi_sharp(topology.vertex_sharpness(vertex)) ||
         std::any_of(ring.sharpness.begin(), ring.sharpness.end(), is_semi_sharp);
}

/// By OpenSubdiv's masks, where nothing fades any more.
void expect_same_corner_limits(Mesh mesh, const Scheme& scheme, int levels) {
  if (scheme.face_varying == FaceVaryingRule::None) mesh = without_returning_values(std::move(mesh));
  const Attribute& given = mesh.attributes[0];
  const Oracle oracle(mesh, scheme, levels, &given);
  FaceVaryingSurface surface = face_varying_surface(Topology(mesh), scheme, given);
  for (int level = 0; level < levels; ++level) surface = surface.refined();
  LimitOptions options;
  options.masks = LimitMasks::OpenSubdiv;
  surface.values = LimitMatrix(surface.topology, surface.scheme, options).apply(surface.values);
  const Values ours = at_half_edges(surface.attribute("uv"));
  const Values theirs = oracle.corner_limits();
  const Topology& last = oracle.topology(levels);
  const double size = std::max(1.0, given.values.cwiseAbs().maxCoeff());
  for (Index h = 0; h < last.half_edge_count(); ++h) {
    if (fades_at(last, last.origin(h))) continue;
    const bool at_seam = surface.topology.is_boundary_vertex(surface.topology.origin(h));
    const double tolerance = (at_seam ? kSeamLimitTolerance : kCornerTolerance) * size;
    ASSERT_LE(worst_corner(ours.row(h), theirs.row(h)), tolerance) << "half-edge " << h;
  }
}

/// Seams of chance: some corners get rows of their own, some vertices several, and vertices and pieces share rows.
Attribute with_random_seams(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  const Index count = 2 * mesh.vertex_count();
  Attribute attribute{"uv", Values::Random(count, 2), {}};
  for (const Index v : mesh.face_vertices) {
    const bool apart = random() % 4 == 0;
    attribute.corner_rows.push_back(apart ? static_cast<Index>(random() % static_cast<unsigned>(count)) : v);
  }
  return attribute;
}

/// Without the semi-sharp creases on seams: there OpenSubdiv keeps a value that depends on another sharp for a level
/// more.
Mesh without_fading_seams(Mesh mesh) {
  const Topology topology(mesh);
  const Buffer<Index>& rows = mesh.attributes[0].corner_rows;
  std::vector<Crease> kept;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    const Index twin = topology.twin(h);
    const float sharpness = twin < 0 ? 0.0F : topology.edge_sharpness(e);
    const bool seam = twin >= 0 && (rows[h] != rows[topology.next(twin)] || rows[topology.next(h)] != rows[twin]);
    if (!is_sharp(sharpness) || (seam && is_semi_sharp(sharpness))) continue;
    kept.push_back({topology.origin(h), topology.destination(h), sharpness});
  }
  mesh.creases = std::move(kept);
  return mesh;
}

class FaceVaryingShapes : public ShapeTest {
 protected:
  /// Calls check(scheme) with each rule.
  template <typename Check>
  void for_each_rule(const Check& check) {
    for (const FaceVaryingRule rule : kRules) {
      SCOPED_TRACE("rule " + std::to_string(static_cast<int>(rule)));
      scheme.face_varying = rule;
      check(scheme);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Conformance, FaceVaryingShapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(FaceVaryingShapes, RefineTheirTexturesAsOpenSubdivDoes) {
  const Attribute* given = texture_coordinates(mesh);
  if (given == nullptr) GTEST_SKIP() << "no texture coordinates";
  const Mesh textured = with_corners(mesh, *given);
  for_each_boundary_rule(
      [&](const Scheme&) { for_each_rule([&](const Scheme& each) { expect_same_corners(textured, each, 3); }); });
}

TEST_P(FaceVaryingShapes, HaveTheLimitsOfTheirTexturesThatOpenSubdivHas) {
  const Attribute* given = texture_coordinates(mesh);
  if (given == nullptr) GTEST_SKIP() << "no texture coordinates";
  const Mesh textured = with_corners(mesh, *given);
  for_each_rule([&](const Scheme& each) {
    if (!each.has_linear_corners()) expect_same_corner_limits(textured, each, 3);
  });
}

// Chaikin's creases that meet at a seam are averaged on either side by itself here.

TEST_P(FaceVaryingShapes, RefineRandomSeamsAsOpenSubdivDoes) {
  scheme.crease_method = CreaseMethod::Uniform;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Mesh textured = with_corners(mesh, with_random_seams(mesh, seed));
    for_each_rule([&](const Scheme& each) { expect_same_corners(textured, each, 2); });
  }
}

TEST_P(FaceVaryingShapes, RefineRandomSeamsAndTagsAsOpenSubdivDoes) {
  scheme.crease_method = CreaseMethod::Uniform;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Mesh tagged = with_random_tags(mesh, seed);
    const Mesh textured = without_fading_seams(with_corners(tagged, with_random_seams(mesh, seed)));
    for_each_rule([&](const Scheme& each) { expect_same_corners(textured, each, 3); });
  }
}

}  // namespace
}  // namespace batten::test
