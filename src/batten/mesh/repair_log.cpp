/// Sentences about changes.
#include <algorithm>

#include "batten/mesh/repair_draft.h"

namespace batten {

namespace {

struct Wording {
  const char* word;
  const char* before;
  const char* one;
  const char* many;
  const char* after;
};

const Wording& wording(RepairKind kind) {
  static const Wording words[] = {
      {"bad-faces", "dropped ", "face", "faces", " on vertices that do not exist or are not finite numbers"},
      {"degenerate-faces", "dropped ", "face", "faces", " of fewer than three different vertices"},
      {"simplified-faces", "simplified ", "face", "faces", " that used a vertex twice"},
      {"repeated-faces", "dropped ", "face", "faces", " that repeated another face"},
      {"split-edges", "split ", "edge", "edges", " of more than two faces"},
      {"cut-edges", "cut ", "edge", "edges", " of a piece that has no consistent orientation"},
      {"reversed-faces", "reversed ", "face", "faces", " to agree with the neighbours"},
      {"split-vertices", "copied ", "vertex", "vertices", " where separate sheets met in a point or along an edge"},
      {"welded-vertices", "welded ", "vertex", "vertices", " of open edges to another one at the same place"},
      {"isolated-vertices", "dropped ", "vertex", "vertices", " that no face uses"},
      {"dropped-tags", "dropped ", "tag", "tags", " (crease, corner or hole) on what is not there"}};
  return words[static_cast<int>(kind)];
}

bool names_edges(RepairKind kind) { return kind == RepairKind::SplitEdges || kind == RepairKind::CutEdges; }

/// Such as "12, 17, 40, ..." or "(3, 4), (7, 9), ...".
std::string first_elements(const RepairChange& change) {
  constexpr std::size_t kShown = 5;
  const std::size_t step = names_edges(change.kind) ? 2 : 1;
  std::string text;
  for (std::size_t i = 0; i < change.elements.size(); i += step) {
    if (i > 0) text += ", ";
    if (i / step == kShown) return text + "...";
    const std::string first = std::to_string(change.elements[i]);
    text += step == 1 ? first : "(" + first + ", " + std::to_string(change.elements[i + 1]) + ")";
  }
  return text;
}

/// Such as "12,345".
std::string grouped(Index count) {
  std::string text = std::to_string(count);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > 0; place -= 3) {
    text.insert(static_cast<std::size_t>(place), ",");
  }
  return text;
}

std::string sentence(const RepairChange& change) {
  const Wording& words = wording(change.kind);
  const std::string text =
      words.before + grouped(change.count) + " " + (change.count == 1 ? words.one : words.many) + words.after;
  return change.elements.empty() ? text : text + ": " + first_elements(change);
}

/// Sorts the elements, `step` numbers each, and removes repetitions.
void tidy(std::vector<Index>& elements, std::size_t step) {
  std::vector<std::pair<Index, Index>> items;
  for (std::size_t i = 0; i < elements.size(); i += step) {
    const Index other = step == 2 ? elements[i + 1] : 0;
    items.emplace_back(step == 2 ? std::min(elements[i], other) : elements[i],
                       step == 2 ? std::max(elements[i], other) : 0);
  }
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
  elements.clear();
  for (const auto& item : items) {
    elements.push_back(item.first);
    if (step == 2) elements.push_back(item.second);
  }
}

}  // namespace

RepairChange& RepairLog::of(RepairKind kind) {
  auto place = std::find_if(changes_.begin(), changes_.end(), [&](const auto& change) { return change.kind >= kind; });
  if (place == changes_.end() || place->kind != kind) place = changes_.insert(place, {kind, 0, {}, ""});
  return *place;
}

std::vector<RepairChange> RepairLog::take() {
  for (RepairChange& change : changes_) {
    const std::size_t step = names_edges(change.kind) ? 2 : 1;
    tidy(change.elements, step);
    if (!change.elements.empty()) change.count = static_cast<Index>(change.elements.size() / step);
    change.text = sentence(change);
  }
  return std::move(changes_);
}

std::string repair_word(RepairKind kind) { return wording(kind).word; }

}  // namespace batten
