/// What the tool says of command lines that make no sense: exit code 2 and one line in words.
#include <algorithm>

#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

class Usage : public Tool {
 protected:
  void expect_refused(const std::string& command, const std::string& part) const {
    const Outcome result = run(command);
    EXPECT_EQ(result.status, 2) << command << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << command << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << command << "\n" << result.err;
    EXPECT_EQ(result.err.rfind("batten: ", 0), 0U) << result.err;
  }
  const std::string tetrahedron_ = kModels + "tetrahedron.obj ";
  const std::string tripod_ = kModels + "tripod.obj ";
};

TEST_F(Usage, AMisspeltWordGetsTheNearestOne) {
  expect_refused("subdivid x.obj", "'subdivid' is not a verb (did you mean subdivide?)");
  expect_refused("interpoalte x.obj", "did you mean interpolate?");
  expect_refused("conv x.obj", "did you mean convert?");
  expect_refused("frobnicate x.obj", "'frobnicate' is not a verb; name one of interpolate, subdivide");
  expect_refused("", "name a verb: interpolate, subdivide");
  expect_refused("subdivide x.obj --level 3", "--level: subdivide has no such option (did you mean --levels?)");
  expect_refused("subdivide x.obj --level=3", "(did you mean --levels?)");
  expect_refused("subdivide -levels 3 x.obj", "(did you mean --levels?)");
  expect_refused("render x.obj --colour mean -o a.png", "(did you mean --color?)");
  expect_refused("subdivide x.obj --scheme lop", "(did you mean loop?)");
  expect_refused("--versoin", "(did you mean --version?)");
  expect_refused("subdivide x.obj --frobnicate 3", "--frobnicate: subdivide has no such option (see");
}

TEST_F(Usage, WordsSayWhatIsMissingOrTooMuch) {
  expect_refused("subdivide x.obj --levels", "--levels needs a value");
  expect_refused("subdivide x.obj --levels 1 --levels 2", "--levels is given more than once");
  expect_refused("subdivide x.obj y.obj", "'y.obj': subdivide takes no further file");
  expect_refused("distance x.obj", "SURFACE is required");
  expect_refused("segment x.nii -o a.obj --seed 1,2", "--seed takes 3 numbers with commas between");
  expect_refused("segment x.nii -o a.obj --seed a,b,c", "--seed: 'a,b,c' is not a number");
}

TEST_F(Usage, NumbersOutOfRangeAreRefusedInWords) {
  expect_refused("subdivide x.obj --levels -1", "--levels: '-1' is not a whole number (0 to 16)");
  expect_refused("subdivide x.obj --levels 1.5", "--levels: '1.5' is not a whole number (0 to 16)");
  expect_refused("info x.obj --threads -2", "--threads: '-2' is not a whole number (0 or more)");
  expect_refused("interpolate x.obj --max-iterations -5", "'-5' is not a whole number (1 or more)");
  expect_refused("texture x.obj --seed -1", "--seed: '-1' is not a whole number");
  expect_refused("render x.obj -o a.png --width -3", "'-3' is not a whole number (1 to 16384)");
  expect_refused("interpolate x.obj --tolerance nan", "--tolerance: 'nan' is not a number above 0");
  expect_refused("interpolate x.obj --alpha nan", "--alpha: 'nan' is not a number from 0 to 1");
  expect_refused("render x.obj -o a.png --view 0,0,0", "--view: '0,0,0' is no direction");
  expect_refused("segment x.nii -o a.obj --label a", "--label: 'a' is not a number");
  expect_refused("segment x.nii -o a.obj --label ''", "--label: '' is not a number");
  expect_refused("denoise x.obj --passes 1e3", "'1e3' is not a whole number (0 to 1000000)");
}

TEST_F(Usage, OptionsWithoutAnEffectAreRefused) {
  expect_refused("interpolate x.obj -o a.obj --color mean", "--color does nothing without --picture");
  expect_refused("subdivide x.obj -o a.obj --turntable 8", "--turntable does nothing without --picture");
  expect_refused("texture x.obj -o a.obj --width 8", "--width does nothing without --picture or --gallery");
  expect_refused("interpolate x.obj -o a.obj --picture a.png --range 0:1", "--range does nothing without --color");
  expect_refused("interpolate x.obj -o a.obj --color mean --range 0:1", "does nothing without --picture");
  expect_refused("render x.obj -o a.png --color zebra --range 0:1", "--range does nothing with --color zebra");
  expect_refused("render x.obj -o a.png --color mean --range 1:0", "'1:0' is not a range like 0:2.5");
  expect_refused("render x.obj -o a.png --values y.ply --color mean", "--color does nothing with --values");
  expect_refused("render x.obj -o a.png --value height", "--value does nothing without --values");
  expect_refused("render x.obj -o a.png --flat --features 40", "--features does nothing with --flat");
  expect_refused("denoise x.obj -o a.obj --color-moved", "--color-moved does nothing without --picture");
  expect_refused("interpolate x.obj --report r.json --ascii", "--ascii does nothing without --output");
  expect_refused("convert x.obj -o a.obj --ascii", "--ascii does nothing for .obj");
  expect_refused("interpolate x.obj --report r.json --levels 2", "--levels does nothing without --output");
  expect_refused("interpolate x.obj -o a.obj --omega 0.5", "--omega does nothing without");
  expect_refused("subdivide x.obj -o a.obj --max-faces 100", "--max-faces does nothing without --chord or");
  expect_refused("subdivide x.obj -o a.obj --chord 1% --limit", "--limit does nothing with a bound");
  expect_refused("render x.obj -o a.png --flat --levels 2", "--levels does nothing with --flat");
  expect_refused("render x.obj -o a.png --flat --scheme loop", "--scheme does nothing with --flat");
  expect_refused("render x.obj -o a.png --targets y.obj", "--targets does nothing without --color error");
  expect_refused("bands x.obj --report r.json --displacements", "--displacements does nothing without --output");
  expect_refused("morph x.obj y.obj -o a.ply --rho 0.5 --order low-last", "--order does nothing with --rho");
  expect_refused("morph x.obj y.obj -o a.ply --rho 0.5 --stages 2", "--stages does nothing with --rho");
  expect_refused("morph x.obj y.obj -o a.ply --no-align", "--no-align does nothing without --rho");
  expect_refused("morph x.obj y.obj -o a.ply --seconds 3", "--seconds does nothing without a .glb");
  expect_refused("morph x.obj y.obj -o a.glb --at 0.5", "--at writes shapes, not an animation");
  expect_refused("morph x.obj y.obj -o a.glb --rho 0.5", "--rho writes shapes, not an animation");
  expect_refused("morph x.obj y.obj -o a.ply --rho 0.5 --at 0.5", "--at belongs to the morph without it");
  expect_refused("morph x.obj y.obj -o - --output-format ply", "standard output takes one file");
}

TEST_F(Usage, OptionsOfAnotherSchemeAreRefused) {
  const std::string subdivide = "subdivide " + tripod_ + "-o a.obj ";
  expect_refused(subdivide + "--tension 0.1", "--tension does nothing with Catmull-Clark, only with Butterfly");
  expect_refused(subdivide + "--butterfly-boundary reflect", "does nothing with Catmull-Clark");
  const std::string loop = "subdivide " + tetrahedron_ + "-o a.obj ";
  expect_refused(loop + "--alpha 0.5", "--alpha does nothing with Loop, only with Catmull-Clark");
  expect_refused(loop + "--triangles smooth", "--triangles does nothing with Loop");
  EXPECT_FALSE(fs::exists(path("a.obj")));
  EXPECT_EQ(run(loop + "--scheme butterfly --tension 0.1").status, 0);
  EXPECT_EQ(run("subdivide " + tetrahedron_ + "--compare --levels 1 --butterfly-boundary reflect").status, 0);
}

TEST_F(Usage, AVerbWithoutAnOutputIsRefused) {
  const std::string part = ": nothing would be written; give one of --";
  for (const std::string verb :
       {"interpolate", "subdivide", "convert", "repair", "denoise", "sharpen", "bands", "texture"})
    expect_refused(verb + " x.obj", verb + part);
  expect_refused("morph x.obj y.obj", "morph" + part);
  expect_refused("fit x.xyz", "give one of --report, --output, --residuals, --film, --picture, --frames (see");
  EXPECT_EQ(run("interpolate " + tripod_ + "--compare-methods").status, 0);
  EXPECT_EQ(run("subdivide " + tetrahedron_ + "--compare --levels 1").status, 0);
  EXPECT_EQ(run("distance " + tripod_ + tripod_).status, 0);
  EXPECT_EQ(run("bands " + tripod_ + "--report r.json").status, 0);
}

}  // namespace
}  // namespace batten::cli_tests
