/// Files of medial models: 3D Slicer's and our own, sound and damaged.
#include "batten/medial/medial_io.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <regex>

#include "io/io_test_tools.h"
#include "medial/medial_shapes.h"

namespace batten {
namespace {

using io_tests::file_text;
using io_tests::make_file;
using io_tests::same_bits;
using io_tests::TemporaryFolder;
using test::expect_error;

void expect_same_figure(const MedialFigure& a, const MedialFigure& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_TRUE(same_bits(a.sheet.points, b.sheet.points));
  EXPECT_TRUE(same_bits(a.up, b.up));
  EXPECT_TRUE(same_bits(a.down, b.down));
  EXPECT_EQ(a.sheet.face_vertices, b.sheet.face_vertices);
  EXPECT_EQ(a.sheet.face_offsets, b.sheet.face_offsets);
  EXPECT_TRUE(same_bits(a.coordinates, b.coordinates));
  ASSERT_EQ(a.crest.size(), b.crest.size());
  std::vector<CrestSpoke> others = b.crest;
  for (const CrestSpoke& crest : a.crest) {
    const auto same = [&](const CrestSpoke& other) {
      return other.atom == crest.atom && other.origin == crest.origin && other.spoke == crest.spoke;
    };
    EXPECT_EQ(std::count_if(others.begin(), others.end(), same), 1) << crest.atom;
  }
}

/// What a file with this text is read as.
MedialModel read_text(const std::string& text) {
  const TemporaryFolder folder;
  make_file(folder.path("model.json"), text);
  return read_medial(folder.path("model.json"));
}

/// The text of a sound s-rep of 8 lines and 2 steps.
std::string srep_text() {
  const TemporaryFolder folder;
  write_medial(folder.path("a.srep.json"), test::ellipse(8, 2));
  return file_text(folder.path("a.srep.json"));
}

/// The text with one of the places where it says `from` changed, counted from 0.
std::string changed(const std::string& text, const std::string& from, const std::string& to, int which = 0) {
  std::string result = text;
  std::size_t at = result.find(from);
  for (int i = 0; i < which && at != std::string::npos; ++i) at = result.find(from, at + 1);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the text lacks " << from;
    return result;
  }
  return result.replace(at, from.size(), to);
}

TEST(MedialFiles, SrepReadsBackBitForBit) {
  const MedialModel model = test::ellipse(8, 2);
  const MedialModel read = read_text(srep_text());
  ASSERT_EQ(read.figures.size(), 1U);
  expect_same_figure(read.figures.front(), model.figures.front());
  ASSERT_TRUE(read.figures.front().grid);
  EXPECT_EQ(read.figures.front().grid->crest_points, 8);
}

TEST(MedialFiles, FiguresReadBackBitForBit) {
  MedialModel model = test::slab(3, 4);
  model.figures.front().name = "slab";
  model.figures.front().crest.front().origin.x() -= 0.25;
  model.figures.push_back(test::slab(2, 2).figures.front());
  const TemporaryFolder folder;
  write_medial(folder.path("a.json"), model);
  const MedialModel read = read_medial(folder.path("a.json"));
  ASSERT_EQ(read.figures.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) expect_same_figure(read.figures[i], model.figures[i]);
}

/// Every second spoke in RAS: the same model.
TEST(MedialFiles, RasBesideLpsComesToOneFrame) {
  const std::string text = srep_text();
  const std::regex vector(R"re("LPS",\s*"Value":\s*\[\s*([-+.e0-9]+),\s*([-+.e0-9]+),)re");
  std::string mixed;
  std::size_t last = 0;
  int number = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), vector), end; it != end; ++it, ++number) {
    const auto begin = static_cast<std::size_t>(it->position());
    mixed += text.substr(last, begin - last);
    const auto turned = [](const std::string& digits) { return digits[0] == '-' ? digits.substr(1) : "-" + digits; };
    mixed += number % 2 == 0 ? it->str()
                             : "\"RAS\", \"Value\": [" + turned((*it)[1].str()) + ", " + turned((*it)[2].str()) + ",";
    last = begin + static_cast<std::size_t>(it->length());
  }
  mixed += text.substr(last);
  EXPECT_GT(number, 100);
  const MedialModel read = read_text(mixed);
  const MedialModel model = test::ellipse(8, 2);
  EXPECT_EQ((read.figures.front().sheet.points - model.figures.front().sheet.points).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ((read.figures.front().up - model.figures.front().up).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ((read.figures.front().down - model.figures.front().down).cwiseAbs().maxCoeff(), 0.0);
}

/// Each point has an UpSpoke: that of line 2, step 1 is number 3 * 2 + 1.
TEST(MedialFiles, DamagedSrepsNameLineAndStep) {
  const std::string text = srep_text();
  const auto expect = [](const std::string& damaged, const std::string& part) {
    expect_error([&] { read_text(damaged); }, ErrorCode::BadFile, part);
  };
  expect(changed(text, "\"UpSpoke\"", "\"Upspoke\"", 3 * 2 + 1), "line 2, step 1: UpSpoke is missing");
  expect(changed(text, "\"CrestSpoke\"", "\"Crest\"", 5), "line 5, step 2: CrestSpoke is missing");
  expect(changed(text, "\"LPS\"", "\"LAS\""),
         "line 0, step 0, UpSpoke, SkeletalPoint, CoordinateSystem: 'LAS' is an unknown");
  expect(changed(text, "\"Direction\"", "\"Directions\"", 1), "line 0, step 0, DownSpoke: Direction is missing");
  expect(changed(text, "\"CrestPoints\": 8", "\"CrestPoints\": 1000000000"),
         "line 8 is missing: CrestPoints says 1000000000");
  expect(changed(text, "\"CrestPoints\": 8", "\"CrestPoints\": 6"), "CrestPoints says 6");
  expect(changed(text, "\"Steps\": 2", "\"Steps\": 3"), "line 0: step 3 is missing");
  expect(changed(text, "\"Steps\": 2", "\"Steps\": -2"), "Steps: a whole number");
  expect(changed(text, "\"Steps\": 2", "\"Steps\": 2.5"), "Steps: a whole number");
}

TEST(MedialFiles, WrongNumbersNameLineAndStep) {
  const std::string text = srep_text();
  // The first number of the first spoke of line 1, step 0.
  std::size_t at = 0;
  for (int i = 0; i < 4; ++i) at = text.find("\"UpSpoke\"", at + 1);
  at = text.find('[', at) + 1;
  const std::size_t end = text.find(',', at);
  const auto with = [&](const std::string& number) { return text.substr(0, at) + number + text.substr(end); };
  const auto expect = [&](const std::string& number, const std::string& part) {
    expect_error([&] { read_text(with(number)); }, ErrorCode::BadFile, "line 1, step 0, UpSpoke, SkeletalPoint, Value");
    expect_error([&] { read_text(with(number)); }, ErrorCode::BadFile, part);
  };
  expect("\"1.5\"", "a number is expected here, not \"1.5\"");
  expect("null", "a number is expected here, not null");
  expect("NaN", "not JSON");
  expect("1e999", "not JSON");
  expect("1, 2", "a list of 3 numbers");
}

TEST(MedialFiles, SpokesOfNoLengthAndTornSpinesAreRefused) {
  MedialModel model = test::ellipse(8, 2);
  const TemporaryFolder folder;
  write_medial(folder.path("a.srep.json"), model);
  std::string text = file_text(folder.path("a.srep.json"));
  // Line 6 shares the third point of the spine with line 2; the shift is far above six digits.
  std::size_t at = 0;
  for (int i = 0; i < 3 * 6 + 1; ++i) at = text.find("\"UpSpoke\"", at + 1);
  at = text.find("Direction", at);
  at = text.find('[', at) + 1;
  expect_error([&] { read_text(text.substr(0, at) + "3.0" + text.substr(text.find(',', at))); }, ErrorCode::BadFile,
               "line 6, step 0: this point of the spine differs from that of line 2");
  const std::size_t close = text.find(']', at);
  expect_error([&] { read_text(text.substr(0, at) + "0, 0, 0" + text.substr(close)); }, ErrorCode::BadFile,
               "line 6, step 0, UpSpoke, Direction: the length of the spoke is 0");
}

TEST(MedialFiles, WhatIsNoModelIsRefused) {
  for (const char* text : {"{}", "[]", "3", "{\"EllipticalSRep\": 3}", "{\"EllipticalSRep\": {}}", "{\"figures\": []}",
                           "{\"figures\": 1}", "not json", "{\"figures\": [{\"atoms\": []}]}"}) {
    expect_error([&] { read_text(text); }, ErrorCode::BadFile, "model.json: ");
  }
  expect_error([] { read_medial("no-such.srep.json"); }, ErrorCode::FileNotReadable, "no-such");
}

TEST(MedialFiles, WhatStandsForANumberIsNamed) {
  const auto with_rows = [](const std::string& rows) {
    return R"({"figures": [{"grid": [)" + rows + R"(, 2], "atoms": [{}]}]})";
  };
  expect_error([&] { read_text(with_rows("[3]")); }, ErrorCode::BadFile,
               "figure 0, grid, entry 0: a number is expected here, not a list");
  expect_error([&] { read_text(with_rows("{}")); }, ErrorCode::BadFile, "not an object");
  expect_error([&] { read_text(with_rows("\"two\"")); }, ErrorCode::BadFile, "not \"two\"");
}

/// Such a file may run any program that reads it out of stack.
TEST(MedialFiles, ListsInListsWithoutEndAreRefused) {
  for (const std::size_t depth : {std::size_t{100}, std::size_t{1000000}}) {
    const std::string deep = std::string(depth, '[') + std::string(depth, ']');
    expect_error([&] { read_text(R"({"figures": [{"grid": )" + deep + R"(, "atoms": [{}]}]})"); }, ErrorCode::BadFile,
                 "more than 64 deep");
  }
}

/// Whatever is changed in a file, the reader gives a sound model or an Error.
TEST(MedialFiles, DamageOfAnyKindIsAnError) {
  const TemporaryFolder folder;
  MedialModel two = test::slab(2, 3);
  two.figures.push_back(two.figures.front());
  two.hinges.push_back({{1, {0, 3}, {}, SpokeSide::Up}, {0, {}, {0}, SpokeSide::Down}});
  write_medial(folder.path("two.json"), two);
  const std::string signs = "0123456789.-+eE,:[]{}\"NaN null\n\\";
  std::mt19937 random(1);
  int refused = 0;
  for (const std::string& sound : {srep_text(), file_text(folder.path("two.json"))}) {
    for (int i = 0; i < 200; ++i) {
      std::string text = sound;
      for (unsigned k = 0; k <= random() % 3; ++k) {
        const std::size_t at = random() % text.size();
        if (random() % 3 == 0) {
          text.erase(at, random() % 40);
        } else {
          text[at] = signs[random() % signs.size()];
        }
      }
      try {
        require_medial(read_text(text));
      } catch (const Error& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("model.json: "), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(refused, 50);
}

/// Directions with radii, elongations and the crest's own start.
TEST(MedialFiles, FiguresOfDirectionsAndElongations) {
  const MedialModel read = read_text(R"({"figures": [{"name": "tile", "grid": [2, 2], "atoms": [
    {"position": [0, 0, 0], "radius": 2, "up": [-3, 0, 4], "down": [-3, 0, -4]},
    {"position": [1, 0, 0], "radius": [1, 3], "up": [0.6, 0, 0.8], "down": [0.6, 0, -0.8], "elongation": 1.5},
    {"position": [0, 1, 0], "up": [-3, 0, 4], "down": [-3, 0, -4], "crest": [-6, 0, 0]},
    {"position": [1, 1, 0], "up": [1, 0, 1], "down": [1, 0, -1], "crest": {"position": [2, 1, 0], "spoke": [1, 0, 0]}}
  ]}]})");
  const MedialFigure& figure = read.figures.front();
  EXPECT_EQ(figure.name, "tile");
  EXPECT_LT((figure.up.row(0) - Eigen::RowVector3d(-1.2, 0.0, 1.6)).norm(), 1e-15);
  EXPECT_LT((figure.down.row(1) - Eigen::RowVector3d(1.8, 0.0, -2.4)).norm(), 1e-15);
  EXPECT_EQ(figure.up.row(2), Eigen::RowVector3d(-3.0, 0.0, 4.0));
  ASSERT_EQ(figure.crest.size(), 4U);
  EXPECT_LT((figure.crest[0].spoke - Eigen::Vector3d(-2.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((figure.crest[1].spoke - Eigen::Vector3d(3.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_EQ(figure.crest[2].spoke, Eigen::Vector3d(-6.0, 0.0, 0.0));
  EXPECT_EQ(figure.crest[3].origin, Eigen::Vector3d(2.0, 1.0, 0.0));
}

TEST(MedialFiles, DamagedFiguresNameTheAtom) {
  const std::string sound = R"({"figures": [{"grid": [2, 2], "atoms": [
    {"position": [0, 0, 0], "radius": 1, "up": [-1, 0, 1], "down": [-1, 0, -1]},
    {"position": [1, 0, 0], "radius": 1, "up": [1, 0, 1], "down": [1, 0, -1]},
    {"position": [0, 1, 0], "radius": 1, "up": [-1, 0, 1], "down": [-1, 0, -1]},
    {"position": [1, 1, 0], "radius": 1, "up": [1, 0, 1], "down": [1, 0, -1]}]}]})";
  EXPECT_EQ(read_text(sound).figures.size(), 1U);
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& part) {
    expect_error([&] { read_text(changed(sound, from, to)); }, ErrorCode::BadFile, part);
  };
  expect("\"radius\": 1", "\"radius\": 0", "figure 0, atom 0, radius: the radius is not above 0");
  expect("\"radius\": 1", "\"radius\": \"one\"", "figure 0, atom 0, radius: a number is expected");
  expect("[1, 0, 0]", "[1, 0]", "figure 0, atom 1, position: a list of 3 numbers");
  expect("\"down\": [-1, 0, -1]", "\"down\": [1, 0, -1]", "figure 0, atom 0: the two spokes are opposite");
  expect("[2, 2]", "[3, 2]", "figure 0, grid: ");
  expect("\"grid\": [2, 2]", "\"faces\": [[0, 1, 3, 7]]", "figure 0, face 0: atom 7 does not exist");
  expect("\"grid\": [2, 2]", "\"faces\": [[0, 1, 3]]", "figure 0, atom 2: the atom is in no face");
  expect("\"radius\": 1,", "\"elongation\": -1,", "figure 0, atom 0, elongation: ");
  expect("\"radius\": 1,", "\"radios\": 1,",
         "figure 0, atom 0: there is no key \"radios\" here (did you mean radius?)");
  expect("\"grid\"", "\"gird\"", "figure 0: there is no key \"gird\" here (did you mean grid?)");
  expect("{\"figures\"", "{\"hinge\": [], \"figures\"", "there is no key \"hinge\" here (did you mean hinges?)");
}

TEST(MedialFiles, RefusesToWriteWhatAnSrepCannotHold) {
  const TemporaryFolder folder;
  expect_error([&] { write_medial(folder.path("a.srep.json"), test::slab(3, 3)); }, ErrorCode::BadArgument,
               "one figure on an elliptical grid");
  expect_error([&] { write_medial(folder.path("a.obj"), test::slab(3, 3)); }, ErrorCode::UnknownFormat, "a.obj");
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(MedialFiles, RealSrepIsRead) {
  const char* data = std::getenv("BATTEN_DATA");
  if (data == nullptr) GTEST_SKIP() << "set BATTEN_DATA to the folder of test data";
  const MedialModel model = read_medial(std::string(data) + "/medial/bent.srep.json");
  const MedialFigure& figure = model.figures.front();
  EXPECT_EQ(figure.grid->crest_points, 24);
  EXPECT_EQ(figure.grid->steps, 2);
  EXPECT_EQ(figure.atom_count(), 13 + 48);
  EXPECT_EQ(figure.up.row(0), Eigen::RowVector3d(-1.26165, 0.0, 2.86486));
  const TemporaryFolder folder;
  write_medial(folder.path("again.srep.json"), model);
  expect_same_figure(read_medial(folder.path("again.srep.json")).figures.front(), figure);
}

}  // namespace
}  // namespace batten
