/// Broken shapes and models: what repair does to each, and that the result interpolates.
#include <cctype>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/repair.h"
#include "conformance/conformance_data.h"

namespace batten::test {
namespace {

struct BrokenFile {
  std::string path;
  std::string changes;  ///< kind by kind, with counts
};

const std::vector<BrokenFile>& broken_files() {
  static const std::vector<BrokenFile> list{
      {"osd-shapes/catmark_nonman_bareverts", "isolated-vertices 10"},
      // A hundred fins that all pass the edge in the same direction: no two make a sheet.
      {"osd-shapes/catmark_nonman_edge100", "split-edges 1, split-vertices 2"},
      {"osd-shapes/loop_nonman_edge100", "split-edges 1, split-vertices 2"},
      {"osd-shapes/catmark_nonman_quadpole64", "simplified-faces 64"},
      {"osd-shapes/catmark_nonman_verts", "split-vertices 4, isolated-vertices 1"},
      {"osd-shapes/loop_nonman_edges",
       "degenerate-faces 4, split-edges 6, reversed-faces 4, split-vertices 9, isolated-vertices 1"},
      {"osd-shapes/loop_val2_interior", "repeated-faces 1, split-edges 1, split-vertices 3"},
      {"osd-shapes/catmark_val2_back2back", ""},
      {"osd-shapes/catmark_val2_foldover", ""},
      {"osd-shapes/catmark_val2_interior", ""},
      {"osd-shapes/catmark_pole360", ""},
      {"osd-shapes/loop_pole8", ""},
      {"meshes/beetle", "split-edges 47, split-vertices 42"},
      {"meshes/teapot", "split-vertices 1, welded-vertices 402"},
      {"meshes/stanford-bunny", "isolated-vertices 1113"},
      {"meshes/beetle-alt", ""}};
  return list;
}

class Mended : public testing::TestWithParam<BrokenFile> {};

TEST_P(Mended, AsExpectedAndThenInterpolates) {
  BATTEN_REQUIRE_DATA();
  const RepairResult result = repair(read_mesh(data_folder() + "/" + GetParam().path + ".obj"));
  std::string changes;
  for (const RepairChange& change : result.changes) {
    changes += (changes.empty() ? "" : ", ") + repair_word(change.kind) + " " + std::to_string(change.count);
  }
  EXPECT_EQ(changes, GetParam().changes);
  EXPECT_TRUE(repair(result.mesh).changes.empty());
  const Topology topology(result.mesh);
  const Scheme scheme = scheme_of_shape(GetParam().path.substr(GetParam().path.find('/') + 1), result.mesh);
  const Interpolant interpolant = Interpolator(topology, scheme).solve(result.mesh.points);
  EXPECT_TRUE(interpolant.report.converged());
  EXPECT_LE(interpolant.report.max_error, 1e-10 * bounding_diagonal(result.mesh.points));
}

INSTANTIATE_TEST_SUITE_P(Repair, Mended, testing::ValuesIn(broken_files()), [](const auto& tested) {
  std::string name = tested.param.path.substr(tested.param.path.find('/') + 1);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

/// What conformance_data.h lists as refused is what repair is for.
TEST(Repair, MendsEveryRefusedFile) {
  BATTEN_REQUIRE_DATA();
  for (const RefusedFile& file : refused_files()) {
    EXPECT_NO_THROW(Topology(repair(read_mesh(data_folder() + "/" + file.path + ".obj")).mesh)) << file.path;
  }
}

}  // namespace
}  // namespace batten::test
