/// The documentation is true: the commands on each page run, in the page's order, in a fresh folder with the models;
/// its links lead somewhere.
///
/// A command is a line of an indented or fenced block that starts with "./batten" or "batten", with what "\" continues.
/// The script's own verbs (test, bench) are left out, and so is a block after the line <!-- not run: WHY -->.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "cli/text.h"

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
  static const std::regex command(R"(^(\./)?batten +(?!test\b|bench\b)[-a-z].*)");
  return std::regex_match(line, command);
}

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
    std::ofstream(folder / "command.sh") << ". ./path.sh\n" << command << "\n";
    const int status = std::system(("cd '" + folder.string() + "' && sh -e command.sh >said.txt 2>&1").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 0) << command << "\n" << text_of(folder / "said.txt");
  }
  fs::remove_all(folder);
}

TEST_P(Docs, LinksLeadSomewhere) {
  const std::string page = text_of(kSource / GetParam());
  const std::regex link(R"(\]\(([^)#\s]+)(#[^)]*)?\))");
  for (std::sregex_iterator it(page.begin(), page.end(), link), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (target.find("://") != std::string::npos) continue;
    EXPECT_TRUE(fs::exists((kSource / GetParam()).parent_path() / target)) << target;
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
