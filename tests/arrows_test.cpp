/// A room includes only the rooms that its arrow points to (docs/architecture.md), and what those reach.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "support/source_folder.h"

namespace {

namespace fs = std::filesystem;
using Arrows = std::map<std::string, std::set<std::string>>;

const Arrows kArrows = {{"parallel", {}},
                        {"mesh", {"parallel"}},
                        {"solve", {"parallel"}},
                        {"scheme", {}},
                        {"refine", {"mesh", "scheme"}},
                        {"limit", {"refine"}},
                        {"patch", {"refine"}},
                        {"surface", {"limit", "patch"}},
                        {"nearest", {"surface"}},
                        {"tessellate", {"limit", "patch"}},
                        {"adaptive", {"nearest", "tessellate"}},
                        {"io", {"mesh"}},
                        {"render", {"mesh"}},
                        {"energy", {"surface"}},
                        {"interpolate", {"energy", "solve"}},
                        {"expand", {"interpolate", "nearest", "tessellate"}},
                        {"dynamics", {"energy", "solve", "nearest", "io"}},
                        {"fit", {"dynamics", "interpolate", "tessellate"}},
                        {"medial", {"interpolate", "tessellate", "io"}},
                        {"volume", {"fit"}}};

std::set<std::string> reach(const std::string& room) {
  std::set<std::string> reached{room};
  for (const std::string& next : kArrows.at(room)) reached.merge(reach(next));
  return reached;
}

TEST(Arrows, EveryIncludeFollowsTheArrows) {
  const fs::path library = fs::path(batten::test::source_folder()) / "src" / "batten";
  const std::regex include("^\\s*#\\s*include\\s+\"batten/([a-z]+)/[^\"]+\"");
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(library)) {
    if (!entry.is_regular_file()) continue;
    const fs::path relative = fs::relative(entry.path(), library);
    if (std::distance(relative.begin(), relative.end()) < 2) continue;
    const std::string room = relative.begin()->string();
    ASSERT_TRUE(kArrows.count(room)) << "a room that the arrows do not name: " << room;
    const std::set<std::string> allowed = reach(room);
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      ++seen;
      EXPECT_TRUE(allowed.count(match[1])) << relative << " may not include " << match[1];
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(Arrows, TheLibraryNeverPrints) {
  const fs::path library = fs::path(batten::test::source_folder()) / "src" / "batten";
  const std::regex print("std::cout|std::cerr|\\bprintf\\(|\\bputs\\(");
  for (const auto& entry : fs::recursive_directory_iterator(library)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      EXPECT_FALSE(std::regex_search(line, print)) << entry.path() << ": " << line;
  }
}

}  // namespace
