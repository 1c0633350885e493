/// What the tool refuses to write over, and what goes to standard output.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

class Files : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    fs::copy_file(kModels + "tetrahedron.obj", path("mesh.obj"));
    fs::copy_file(kModels + "tetrahedron.obj", path("mesh-001.obj"));
    fs::create_symlink(path("mesh.obj"), path("link.obj"));
    fs::create_hard_link(path("mesh.obj"), path("hard.obj"));
    fs::create_directory(path("folder.obj"));
    fs::create_directory_symlink(folder_, path("here"));
    before_ = text_of(path("mesh.obj"));
  }

  /// The command must be refused in one line that has `part`, with this exit code, and change no model.
  void expect_refused(const std::string& command, const std::string& part, int status = 2) const {
    const Outcome result = run(command);
    EXPECT_EQ(result.status, status) << command << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << command << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << command << "\n" << result.err;
    EXPECT_EQ(result.err.rfind("batten: ", 0), 0U) << result.err;
    EXPECT_EQ(text_of(path("mesh.obj")), before_) << command;
    EXPECT_EQ(text_of(path("mesh-001.obj")), before_) << command;
  }

  std::string before_;
};

TEST_F(Files, AnOutputThatIsAnInputIsRefused) {
  const std::string why = "is the file to read";
  for (const char* name : {"mesh.obj", "./mesh.obj", "link.obj", "hard.obj", "here/mesh.obj"}) {
    expect_refused(std::string("subdivide mesh.obj -o ") + name, why);
    expect_refused(std::string("repair ") + name + " -o mesh.obj", why);
  }
  expect_refused("morph mesh-001.obj mesh.obj -o mesh.obj --at 0.5", why);
  write("scan.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n");
  expect_refused("distance scan.ply mesh.obj -o scan.ply", why);
  expect_refused("convert - --input-format obj -o mesh.obj < mesh.obj", why);
  write("scan.nii", "kept");
  expect_refused("segment scan.nii --inside scan.nii", why);
  expect_refused("segment other.nii --mask scan.nii --inside ./scan.nii", why);
  EXPECT_EQ(text_of(path("scan.nii")), "kept");
}

TEST_F(Files, AnOutputThatASceneReadsIsRefused) {
  write("scene.json", "{\"mesh\": \"mesh.obj\", \"time\": {\"seconds\": 0.1}}");
  const std::string why = "is a file to read";
  expect_refused("simulate scene.json --equilibrium -o mesh.obj", why);
  expect_refused("simulate scene.json --state ./mesh.obj", why);
  write("frames.json", "{\"mesh\": \"mesh-001.obj\", \"time\": {\"seconds\": 0.1}}");
  expect_refused("simulate frames.json -o mesh.obj", why);
}

TEST_F(Files, AnEmptyMeshIsNotWrittenAsARepairedOne) {
  write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 2\n");
  const std::string found = "no face is left of 1, and nothing was written; none has three different vertices: ";
  expect_refused("repair line.obj -o none.obj", found + "batten convert writes the points alone as .xyz", 1);
  write("small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_refused("repair small.obj --weld 1 -o none.obj", found + "weld less (--weld) or nothing (--no-weld)\n", 1);
  EXPECT_FALSE(fs::exists(path("none.obj")));
  expect_refused("convert mesh.obj -o ''", "name is empty", 1);
}

TEST_F(Files, AMaterialFileIsNamedFromTheOutput) {
  fs::create_directory(path("in"));
  write("in/square.obj", "mtllib paint.mtl\nmtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl red\nf 1 2 3\n");
  write("in/paint.mtl", "newmtl red\nKd 1 0 0\n");
  EXPECT_EQ(run("convert in/square.obj -o out/deep/square.obj").status, 0);
  EXPECT_EQ(text_of(path("out/deep/square.obj")).find("mtllib ../../in/paint.mtl\nmtllib missing.mtl\n"), 0U);
  EXPECT_EQ(run("subdivide in/square.obj -o in/fine.obj").status, 0);
  EXPECT_EQ(text_of(path("in/fine.obj")).find("mtllib paint.mtl\n"), 0U);
  EXPECT_EQ(run("convert in/square.obj -o - --output-format obj").out.find("mtllib in/paint.mtl\n"), 0U);
}

TEST_F(Files, AnImageIsNamedFromTheOutput) {
  fs::create_directory(path("in"));
  write("in/scan.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile scan.png\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "end_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 6 0 0 1 0 1 1\n");
  write("in/scan.png", "an image");
  EXPECT_EQ(run("convert in/scan.ply -o out/scan.ply --ascii").status, 0);
  EXPECT_NE(text_of(path("out/scan.ply")).find("comment TextureFile ../in/scan.png\n"), std::string::npos);
  EXPECT_EQ(run("convert in/scan.ply -o in/copy.ply --ascii").status, 0);
  EXPECT_NE(text_of(path("in/copy.ply")).find("comment TextureFile scan.png\n"), std::string::npos);
}

TEST_F(Files, AFrameThatIsAnInputIsRefused) {
  expect_refused("morph mesh-001.obj mesh.obj -o mesh.obj --frames 3", "is the file to read");
  expect_refused("morph mesh-001.obj mesh.obj -o here/mesh.obj --frames 3", "is the file to read");
  fs::create_directory(path("b"));
  fs::create_hard_link(path("mesh-001.obj"), path("b/mesh-001.obj"));
  expect_refused("morph b/mesh-001.obj mesh.obj -o b/mesh.obj --frames 3", "a frame would replace");
  EXPECT_EQ(run("morph b/mesh-001.obj mesh.obj -o b/mesh.ply --frames 3").status, 0);
}

TEST_F(Files, OutputsOfAnotherTypeAreRefusedAndNothingIsDone) {
  const std::string part = "should end in ";
  for (const char* option : {"--picture", "--report", "--plot"}) {
    expect_refused(std::string("interpolate mesh.obj -o out.obj ") + option + " mesh.obj", part);
    expect_refused(std::string("interpolate mesh.obj -o out.obj ") + option + " new.txt", part);
    expect_refused(std::string("interpolate mesh.obj -o out.obj ") + option + " none", part);
  }
  expect_refused("texture mesh.obj --gallery mesh.obj", part);
  expect_refused("render mesh.obj -o mesh.obj", part);
  expect_refused("distance mesh.obj mesh.obj -o mesh.obj", part);
  expect_refused("info mesh.obj --report mesh.obj", part);
  expect_refused("subdivide mesh.obj -o out.abc", "the file type 'abc' is unknown", 1);
  EXPECT_FALSE(fs::exists(path("out.obj")));
}

TEST_F(Files, TwoOutputsHaveTwoNames) {
  expect_refused("texture mesh.obj --gallery a.png --picture ./a.png", "is what --");
  expect_refused("convert mesh.obj -o - --output-format obj --report -", "is what --");
  expect_refused("render mesh.obj -o - --turntable 2", "one picture");
}

TEST_F(Files, AFolderIsCalledAFolder) {
  const std::string part = "it is a folder; name a file in it";
  expect_refused("info folder.obj", part, 1);
  expect_refused("info here", part, 1);
  expect_refused("distance here mesh.obj", part, 1);
  expect_refused("render mesh.obj --color error --targets here -o a.png", part, 1);
  expect_refused("interpolate mesh.obj -o a.obj --report here", "should end in .json", 2);
  fs::create_directory(path("folder.json"));
  expect_refused("interpolate mesh.obj -o a.obj --report folder.json", part, 1);
  EXPECT_FALSE(fs::exists(path("a.obj")));
}

TEST_F(Files, EveryOutputGoesToStandardOutput) {
  const std::string small = " --width 64 --height 48 --samples 1";
  const Outcome report = run("interpolate mesh.obj --report -");
  EXPECT_EQ(nlohmann::json::parse(report.out)["verb"], "interpolate");
  EXPECT_NE(report.err.find("max error"), std::string::npos) << report.err;
  EXPECT_EQ(run("render mesh.obj -o -" + small).out.substr(1, 3), "PNG");
  EXPECT_EQ(run("subdivide mesh.obj --picture -" + small).out.substr(1, 3), "PNG");
  EXPECT_EQ(run("texture mesh.obj --levels 1 --gallery -" + small).out.substr(1, 3), "PNG");
  EXPECT_NE(run("interpolate mesh.obj --compare-methods --plot -").out.find("</svg>"), std::string::npos);
  EXPECT_EQ(run("distance mesh.obj mesh.obj -o -").out.rfind("ply\n", 0), 0U);
  const Outcome compared = run("subdivide mesh.obj --compare --levels 1 --report -");
  EXPECT_EQ(nlohmann::json::parse(compared.out)["compared"].size(), 5U);
  EXPECT_FALSE(fs::exists(path("-")));
}

TEST_F(Files, ADeviceMayHaveAnyName) {
  EXPECT_EQ(run("interpolate mesh.obj --report /dev/null --quiet").status, 0);
  const Outcome pipe = run("info mesh.obj --report /dev/stdout");
  EXPECT_EQ(nlohmann::json::parse(pipe.out)["vertices"], 4);
}

}  // namespace
}  // namespace batten::cli_tests
