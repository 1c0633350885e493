#include "batten/medial/json_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

/// Follows the parser through the document, to say where it stopped.
class PlaceTracker {
 public:
  bool follow(Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        open_.push_back({event == Event::array_start, {}});
        break;
      case Event::key:
        open_.back().step.key = value.get<std::string>();
        break;
      case Event::object_end:
      case Event::array_end:
        open_.pop_back();
        finish_value();
        break;
      case Event::value:
        finish_value();
        break;
    }
    return true;
  }
  std::string text() const {
    std::vector<JsonStep> steps;
    for (const Level& level : open_) {
      if (level.is_list || !level.step.key.empty()) steps.push_back(level.step);
    }
    return place_text(steps);
  }

 private:
  struct Level {
    bool is_list;
    JsonStep step;  ///< of the value that comes next, or now
  };
  void finish_value() {
    if (open_.empty()) return;
    if (open_.back().is_list) ++open_.back().step.number;
    open_.back().step.key.clear();
  }
  std::vector<Level> open_;
};

void add_text(const Json& value, std::size_t indent, std::string& text) {
  constexpr std::size_t kShort = 160;
  const std::string line = value.dump();
  if (!value.is_structured() || line.size() <= kShort) {
    text += line;
    return;
  }
  text += value.is_object() ? '{' : '[';
  const char* separator = "\n";
  for (const auto& entry : value.items()) {
    text.append(separator).append(indent + 1, ' ');
    if (value.is_object()) text.append(Json(entry.key()).dump()).append(": ");
    add_text(entry.value(), indent + 1, text);
    separator = ",\n";
  }
  text.append("\n").append(indent, ' ');
  text += value.is_object() ? '}' : ']';
}

/// What an error says that it met instead. Lists and objects are only named; bytes that are no UTF-8 are replaced.
std::string found_text(const Json& value) {
  constexpr std::size_t kLongest = 40;
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, kLongest);
}

/// The parser's message without its own number and place.
std::string reason_of(const Json::exception& error) {
  const std::string text = error.what();
  const std::size_t begin = text.find("] ");
  return begin == std::string::npos ? text : text.substr(begin + 2);
}

}  // namespace

std::string place_text(const std::vector<JsonStep>& steps) {
  std::string text;
  const auto add = [&](const std::string& word) { text.append(text.empty() ? "" : ", ").append(word); };
  const std::vector<std::string>* names = nullptr;
  std::size_t depth = 0;
  for (const JsonStep& step : steps) {
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

Json parse_json(const std::string& name, std::string_view text) {
  // What copies a value calls itself for each that it holds; no model is nearly as deep.
  constexpr int kDeepest = 64;
  const auto require_shallow = [&](int depth, Json::parse_event_t /*event*/, const Json& /*value*/) {
    if (depth <= kDeepest) return true;
    throw Error(ErrorCode::BadFile, name + ": lists or objects lie more than " + std::to_string(kDeepest) +
                                        " deep in each other; no medial model is so");
  };
  try {
    return Json::parse(text.begin(), text.end(), require_shallow);
  } catch (const Json::exception&) {
    // Once more, slower, to know the place.
  }
  PlaceTracker tracker;
  try {
    return Json::parse(text.begin(), text.end(),
                       [&](int, Json::parse_event_t event, Json& value) { return tracker.follow(event, value); });
  } catch (const Json::exception& error) {
    const std::string place = tracker.text();
    throw Error(ErrorCode::BadFile,
                name + ": " + (place.empty() ? "" : place + ": ") + "not JSON: " + reason_of(error));
  }
}

std::string json_text(const Json& document) {
  std::string text;
  add_text(document, 0, text);
  text += '\n';
  return text;
}

JsonPlace JsonPlace::at(const char* key) const {
  if (!value_.is_object()) fail("an object with " + std::string(key) + " is expected here");
  const auto found = value_.find(key);
  if (found == value_.end()) fail(std::string(key) + " is missing");
  return {*this, *found, key, 0};
}

JsonPlace JsonPlace::item(std::size_t number) const { return {*this, value_[number], "", number}; }

std::size_t JsonPlace::size() const {
  if (!value_.is_array()) fail("a list is expected here");
  return value_.size();
}

double JsonPlace::number() const {
  if (!value_.is_number()) fail("a number is expected here, not " + found_text(value_));
  const auto number = value_.get<double>();
  if (!std::isfinite(number)) fail("the number is not finite");
  return number;
}

Index JsonPlace::index() const {
  const double value = number();
  if (!value_.is_number_integer() || value < 0 || value > std::numeric_limits<Index>::max())
    fail("a whole number from 0 on is expected here, not " + found_text(value_));
  return static_cast<Index>(value);
}

std::string JsonPlace::text() const {
  if (!value_.is_string()) fail("a text is expected here");
  return value_.get<std::string>();
}

void JsonPlace::require_list(std::size_t length) const {
  if (!value_.is_array() || value_.size() != length)
    fail("a list of " + std::to_string(length) + " numbers is expected here");
}

Eigen::Vector3d JsonPlace::vector() const {
  require_list(3);
  return {item(0).number(), item(1).number(), item(2).number()};
}

Eigen::Vector2d JsonPlace::pair() const {
  require_list(2);
  return {item(0).number(), item(1).number()};
}

void JsonPlace::fail(const std::string& message) const {
  std::vector<JsonStep> steps;
  for (const JsonPlace* place = this; place->parent_ != nullptr; place = place->parent_)
    steps.push_back({place->key_, place->number_});
  std::reverse(steps.begin(), steps.end());
  const std::string place = place_text(steps);
  throw Error(ErrorCode::BadFile, file_ + ": " + (place.empty() ? "" : place + ": ") + message);
}

}  // namespace batten::medial
