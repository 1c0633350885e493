/// The documentation is true: the commands on each page run, in the page's order, in a fresh folder with the models;
/// its links lead somewhere; what the sources cite is on the pages; the pages name every entry of a report.
///
/// A command is a line of an indented or fenced block that starts with "./batten" or "batten", with what "\" continues.
/// The script's own verbs (test, bench) are left out, and so is a block after the line <!-- not run: WHY -->.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

#include "cli/text.h"
#include "cli/tool.h"

namespace batten::cli_tests {
namespace {

const fs::path kSource = BATTEN_SOURCE_DIR;

/// Every page, relative to the source: README.md, CONTRIBUTING.md and docs/**.md.
std::vector<fs::path> pages() {
  std::vector<fs::path> found{"README.md", "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") found.push_back(fs::relative(entry.path(), kSource));
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool is_command(const std::string& line) {
  static const std::regex command(R"(^(\./)?batten +(?!test\b|bench\b|python\b|blender\b|studio\b)[-a-z].*)");
  return std::regex_match(line, command);
}

#ifdef BATTEN_WITH_VOLUMES
constexpr bool kVolumes = true;
#else
constexpr bool kVolumes = false;
#endif

std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  std::istringstream lines(page);
  bool fenced = false;
  bool skipped = false;
  bool continues = false;
  for (std::string line; std::getline(lines, line);) {
    const bool fence = line.rfind("```", 0) == 0;
    const bool inside = fenced ? !fence : line.rfind("    ", 0) == 0;
    if (line.rfind("<!-- not run:", 0) == 0) skipped = true;
    if (!inside && !fence && !line.empty() && line[0] != '<') skipped = false;
    if (fence && fenced) skipped = false;
    if (fence) fenced = !fenced;
    if (!inside) continue;
    line.erase(0, line.find_first_not_of(' '));
    if (continues) {
      commands.back() += "\n" + line;
    } else if (!skipped && is_command(line)) {
      commands.push_back(line);
    } else {
      continue;
    }
    continues = !line.empty() && line.back() == '\\';
  }
  return commands;
}

class Docs : public testing::TestWithParam<fs::path> {};

TEST_P(Docs, CommandsRun) {
  const fs::path folder = fs::temp_directory_path() / ("batten-docs-" + std::to_string(getpid()));
  fs::create_directories(folder);
  fs::create_symlink(kSource / "models", folder / "models");
  fs::create_symlink(BATTEN_TOOL, folder / "batten");
  std::ofstream(folder / "path.sh") << "PATH=" << fs::path(BATTEN_TOOL).parent_path().string() << ":$PATH\n";
  for (const std::string& command : commands_of(text_of(kSource / GetParam()))) {
    // A build without volumes cannot run these, nor a machine without Debian's mricron-data.
    const bool of_brain = command.find("/usr/share/mricron") != std::string::npos;
    if (of_brain && (!kVolumes || !fs::exists("/usr/share/mricron/templates/ch2.nii.gz"))) continue;
    std::ofstream(folder / "command.sh") << ". ./path.sh\n" << command << "\n";
    const int status = std::system(("cd '" + folder.string() + "' && sh -e command.sh >said.txt 2>&1").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 0) << command << "\n" << text_of(folder / "said.txt");
  }
  fs::remove_all(folder);
}

/// The anchors that a page's headings have: in lower case, with hyphens for spaces and without other signs.
std::set<std::string> anchors_of(const std::string& page) {
  std::set<std::string> anchors;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t text = line.find_first_not_of('#');
    if (text == 0 || text == std::string::npos || line[text] != ' ') continue;
    std::string anchor;
    for (const char sign : line.substr(text + 1)) {
      const auto letter = static_cast<unsigned char>(sign);
      if (std::isalnum(letter) != 0 || sign == '-' || sign == '_') anchor += static_cast<char>(std::tolower(letter));
      if (sign == ' ') anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

TEST_P(Docs, LinksLeadSomewhere) {
  const fs::path path = kSource / GetParam();
  const std::string page = text_of(path);
  const std::regex link(R"(\]\(([^)#\s]*)(#[^)\s]*)?\))");
  for (std::sregex_iterator it(page.begin(), page.end(), link), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (target.find("://") != std::string::npos) continue;
    const fs::path led_to = target.empty() ? path : path.parent_path() / target;
    EXPECT_TRUE(fs::exists(led_to)) << target;
    if (!(*it)[2].matched || led_to.extension() != ".md") continue;
    EXPECT_EQ(anchors_of(text_of(led_to)).count((*it)[2].str().substr(1)), 1U) << (*it)[0];
  }
}

INSTANTIATE_TEST_SUITE_P(Page, Docs, testing::ValuesIn(pages()), [](const auto& page) {
  std::string name = page.param.string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(DocsIndex, ListsEveryPage) {
  const std::string index = text_of(kSource / "docs" / "README.md");
  for (const auto& entry : fs::directory_iterator(kSource / "docs")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".md" || name == "README.md") continue;
    EXPECT_NE(index.find("](" + name + ")"), std::string::npos) << "docs/README.md does not list " << name;
  }
}

/// Every source file under a folder, with the marks of comments and the ends of lines taken out, so that a citation is
/// found where it goes over two lines.
std::vector<std::pair<std::string, std::string>> read_sources() {
  std::vector<std::pair<std::string, std::string>> found;
  for (const char* folder : {"src", "cli", "tests", "bench", "models"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kSource / folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      if (entry.path().filename() == "docs_test.cpp") continue;
      const std::string text = std::regex_replace(text_of(entry.path()), std::regex(R"(\s*\n\s*//+<?)"), "");
      found.emplace_back(fs::relative(entry.path(), kSource).string(), text);
    }
  }
  return found;
}

const std::vector<std::pair<std::string, std::string>>& sources() {
  static const std::vector<std::pair<std::string, std::string>> all = read_sources();
  return all;
}

/// "docs/mathematics.md, SECTION" in a comment: the page has that section.
TEST(DocsCitations, OfSectionsOfTheMathematicsAreThere) {
  const std::set<std::string> anchors = anchors_of(text_of(kSource / "docs" / "mathematics.md"));
  const std::regex citation(R"(docs/mathematics\.md,\s+([A-Z][a-z]+(?: [a-z]+)*))");
  int count = 0;
  for (const auto& [name, text] : sources()) {
    for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it, ++count) {
      std::string anchor = (*it)[1];
      std::replace(anchor.begin(), anchor.end(), ' ', '-');
      anchor[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(anchor[0])));
      EXPECT_EQ(anchors.count(anchor), 1U) << name << " cites " << (*it)[0];
    }
  }
  EXPECT_GT(count, 10);
}

/// "key KEY" in a comment and "[KEY]" on a page: the bibliography has the key, and the page of references all of those.
TEST(DocsCitations, OfSourcesAreInTheBibliography) {
  const std::string bibliography = text_of(kSource / "docs" / "references.bib");
  const std::string references = text_of(kSource / "docs" / "references.md");
  std::set<std::string> keys;
  const std::regex entry(R"(@\w+\{(\w+),)");
  for (std::sregex_iterator it(bibliography.begin(), bibliography.end(), entry), end; it != end; ++it)
    keys.insert((*it)[1]);
  for (const std::string& key : keys) EXPECT_NE(references.find("| " + key + " |"), std::string::npos) << key;
  const auto expect_keys = [&](const std::string& name, const std::string& text, const std::regex& citation) {
    for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it)
      EXPECT_EQ(keys.count((*it)[1]), 1U) << name << " cites " << (*it)[0];
  };
  for (const auto& [name, text] : sources()) expect_keys(name, text, std::regex(R"(\bkey ([A-Za-z]+\d\d)\b)"));
  for (const fs::path& page : pages())
    expect_keys(page.string(), text_of(kSource / page), std::regex(R"(\[([A-Z][A-Za-z]*\d\d|OSD)\])"));
}

/// The names of a report's entries but for the stages and what is named by numbers (faces of 4 vertices).
std::set<std::string> entries_of(const std::string& report) {
  std::set<std::string> names;
  const std::regex entry(R"re("([a-z][a-z_0-9]*)":)re");
  const std::string before_stages = report.substr(0, report.find("\"seconds\":"));
  for (std::sregex_iterator it(before_stages.begin(), before_stages.end(), entry), end; it != end; ++it)
    names.insert((*it)[1]);
  return names;
}

using DocsReport = Tool;

TEST_F(DocsReport, PageNamesEveryEntryOfEveryVerb) {
  const std::string page = text_of(kSource / "docs" / "report.md");
  const auto in_models = [](std::string arguments) { return std::regex_replace(arguments, std::regex("@"), kModels); };
  for (const char* arguments : {"interpolate @dented-cube.obj --compare-methods",
                                "interpolate @pyramid.obj --fair",
                                "subdivide @tetrahedron.obj --levels 1",
                                "subdivide @tripod.obj --chord 1% --edge-length 1 --angle 40",
                                "subdivide @pyramid.obj --compare --levels 2",
                                "distance @cube.obj @cube.obj",
                                "denoise @tripod.obj --auto --features 40",
                                "sharpen @tripod.obj --passes 4",
                                "bands @tripod.obj --count 3",
                                "texture @cube.obj --preset wood --levels 1",
                                "morph @creature.obj @creature-ball.obj --rho 0.5 --frames 3",
                                "fit @cube.obj --init sphere --vertices 100",
                                "medial @bean.srep.json",
                                "medial @fork.json",
                                "medial @slab.json --normals",
                                "interpolate @pipe-joint.obj --normals estimate",
                                "morph @tripod.obj @tripod.obj --resample --at 1",
                                "simulate @springs.scene.json",
                                "simulate @springs.scene.json --equilibrium",
                                "repair @broken-tripod.obj",
                                "info @bracket.obj",
                                "info @broken-tripod.obj"}) {
    const Outcome run_of_verb = run(in_models(arguments) + " --report report.json");
    const std::set<std::string> names = entries_of(text_of(path("report.json")));
    EXPECT_GT(names.size(), 4U) << arguments << "\n" << run_of_verb.err;
    for (const std::string& name : names)
      EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name << " of " << arguments;
  }
}

/// docs/pictures/make runs the pages' commands and takes the pictures from out/.
TEST(DocsPictures, AreShownAndEachHasACommand) {
  std::string shown;
  std::string made;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(kSource / page);
    shown += text;
    for (const std::string& command : commands_of(text)) made += command + "\n";
  }
  for (const auto& entry : fs::directory_iterator(kSource / "docs" / "pictures")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".png") continue;
    EXPECT_NE(shown.find("pictures/" + name + ")"), std::string::npos) << "no page shows " << name;
    const bool by_program = shown.find("(\"out/" + name + "\"") != std::string::npos;  // of docs/python.md
    const bool by_blender = name.rfind("blender", 0) == 0;  // tests/blender/picture.py and operators_picture.py
    EXPECT_TRUE(by_program || by_blender || made.find(" out/" + name) != std::string::npos)
        << "no command makes " << name;
  }
}

TEST(DocsCommands, AreFoundInBlocksAndContinued) {
  const std::string page =
      "    ./batten info a.obj\n\ntext `./batten info b.obj`\n\n```sh\nbatten convert c.obj \\\n  -o d.ply\n```\n"
      "    ./batten test\n    batten: not a command\n\n<!-- not run: no file -->\n\n    ./batten info e.obj\n\n"
      "text\n\n    ./batten info f.obj\n";
  EXPECT_EQ(commands_of(page), (std::vector<std::string>{"./batten info a.obj", "batten convert c.obj \\\n-o d.ply",
                                                         "./batten info f.obj"}));
}

}  // namespace
}  // namespace batten::cli_tests
