#include "conformance/conformance_data.h"
#include "support/tessellation.h"

namespace batten::test {
namespace {

class TessellatedShapes : public ShapeTest {};
INSTANTIATE_TEST_SUITE_P(Conformance, TessellatedShapes, ::testing::ValuesIn(shape_names()), test_name);

TEST_P(TessellatedShapes, AreWhatRefinementGives) {
  const Topology topology(mesh);
  const BoundaryRule own = scheme.boundary;
  for (const auto rule : {BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner}) {
    scheme.boundary = rule;
    for (const int levels : rule == own ? std::vector<int>{1, 4} : std::vector<int>{2}) {
      const TessellationErrors exact = compare_with_refinement<double>(topology, scheme, mesh.points, levels);
      EXPECT_LE(exact.refined, 1e-14);
      EXPECT_LE(exact.limit, 1e-14);
      // Two quads back to back lie in one plane: their fold has no normal.
      if (GetParam() != "catmark_val2_back2back") {
        EXPECT_LE(exact.normal, 1e-9);
      }
      const TessellationErrors rounded = compare_with_refinement<float>(topology, scheme, mesh.points, levels);
      EXPECT_LE(rounded.refined, 2e-7);
      EXPECT_LE(rounded.limit, 2e-7);
    }
  }
}

class TessellatedModels : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Conformance, TessellatedModels, ::testing::ValuesIn(model_names()), test_name);

TEST_P(TessellatedModels, AreWhatRefinementGives) {
  BATTEN_REQUIRE_DATA();
  const Mesh mesh = load_model(GetParam());
  const Topology topology(mesh);
  const TessellationErrors exact = compare_with_refinement<double>(topology, choose_scheme(mesh), mesh.points, 2);
  EXPECT_LE(exact.refined, 1e-14);
  EXPECT_LE(exact.limit, 1e-14);
  EXPECT_LE(exact.normal, 1e-6);
}

}  // namespace
}  // namespace batten::test
