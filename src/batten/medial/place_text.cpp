#include <map>

#include "batten/medial/medial_formats.h"

namespace batten::medial {

namespace {

/// What the entries of a list are called; those of the entries' own lists follow.
const std::map<std::string, std::vector<std::string>> kEntryNames = {{"Skeleton", {"line", "step"}},
                                                                     {"figures", {"figure"}},
                                                                     {"atoms", {"atom"}},
                                                                     {"faces", {"face"}},
                                                                     {"hinges", {"hinge"}}};
/// Lists whose entries' names say enough, and the object around them.
bool speaks_for_itself(const std::string& key) { return key == "EllipticalSRep" || kEntryNames.count(key) > 0; }

}  // namespace

std::string place_text(const std::vector<io::JsonStep>& steps) {
  std::string text;
  const auto add = [&](const std::string& word) { text.append(text.empty() ? "" : ", ").append(word); };
  const std::vector<std::string>* names = nullptr;
  std::size_t depth = 0;
  for (const io::JsonStep& step : steps) {
    if (!step.key.empty()) {
      const auto found = kEntryNames.find(step.key);
      names = found == kEntryNames.end() ? nullptr : &found->second;
      depth = 0;
      if (!speaks_for_itself(step.key)) add(step.key);
      continue;
    }
    const bool named = names != nullptr && depth < names->size();
    add((named ? (*names)[depth] : std::string("entry")) + " " + std::to_string(step.number));
    ++depth;
  }
  return text;
}

}  // namespace batten::medial
