#include "batten/io/json_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "batten/nearest_word.h"

namespace batten::io {

namespace {

[[noreturn]] void fail_at(const JsonName& name, const std::vector<JsonStep>& steps, const std::string& message) {
  const std::string place = name.place_text(steps);
  throw Error(ErrorCode::BadFile, name.file + ": " + (place.empty() ? "" : place + ": ") + message);
}

/// Follows the parser through the document, to say where it stopped, or where a key is given twice.
class PlaceTracker {
 public:
  explicit PlaceTracker(const JsonName& name) : name_(name) {}
  bool follow(Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        open_.push_back({event == Event::array_start, {}, {}});
        break;
      case Event::key:
        open_.back().step.key = value.get<std::string>();
        if (!open_.back().keys.insert(open_.back().step.key).second) fail("is given twice; leave one of them out");
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
  [[noreturn]] void fail(const std::string& message) const {
    std::vector<JsonStep> steps;
    for (const Level& level : open_) {
      if (level.is_list || !level.step.key.empty()) steps.push_back(level.step);
    }
    fail_at(name_, steps, message);
  }

 private:
  struct Level {
    bool is_list;
    JsonStep step;  ///< of the value that comes next, or now
    std::set<std::string> keys;
  };
  void finish_value() {
    if (open_.empty()) return;
    if (open_.back().is_list) ++open_.back().step.number;
    open_.back().step.key.clear();
  }
  const JsonName& name_;
  std::vector<Level> open_;
};

/// The keys of all objects.
std::size_t count_keys(const Json& value) {
  std::size_t count = value.is_object() ? value.size() : 0;
  if (value.is_structured()) {
    for (const Json& entry : value) count += count_keys(entry);
  }
  return count;
}

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

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The parser's message without its own number and place.
std::string reason_of(const Json::exception& error) {
  const std::string text = error.what();
  const std::size_t begin = text.find("] ");
  return begin == std::string::npos ? text : text.substr(begin + 2);
}

}  // namespace

std::string path_text(const std::vector<JsonStep>& steps) {
  std::string text;
  for (const JsonStep& step : steps) {
    if (step.key.empty()) {
      text += "[" + std::to_string(step.number) + "]";
    } else {
      text += (text.empty() ? "" : ".") + step.key;
    }
  }
  return text;
}

Json parse_json(const JsonName& name, std::string_view text) {
  // What copies a value calls itself for each that it holds.
  constexpr int kDeepest = 64;
  std::size_t keys = 0;
  const auto follow_depth = [&](int depth, Json::parse_event_t event, const Json& /*value*/) {
    if (event == Json::parse_event_t::key) ++keys;
    if (depth <= kDeepest) return true;
    throw Error(ErrorCode::BadFile, name.file + ": lists or objects lie more than " + std::to_string(kDeepest) +
                                        " deep in each other; no " + name.kind + " is so");
  };
  try {
    Json document = Json::parse(text.begin(), text.end(), follow_depth);
    if (count_keys(document) == keys) return document;
  } catch (const Json::exception&) {
    // Once more, slower, to know the place.
  }
  PlaceTracker tracker(name);
  try {
    return Json::parse(text.begin(), text.end(),
                       [&](int, Json::parse_event_t event, Json& value) { return tracker.follow(event, value); });
  } catch (const Json::exception& error) {
    tracker.fail("not JSON: " + reason_of(error));
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

void JsonPlace::require_keys(const std::vector<std::string>& keys) const {
  if (!value_.is_object()) fail("an object is expected here, not " + found_text(value_));
  for (const auto& entry : value_.items()) {
    if (std::find(keys.begin(), keys.end(), entry.key()) != keys.end()) continue;
    const std::string near = suggestion(entry.key(), keys);
    fail("there is no key " + found_text(entry.key()) + " here" +
         (near.empty() ? "; the keys are " + joined(keys) : near));
  }
}

double JsonPlace::number() const {
  if (!value_.is_number()) fail("a number is expected here, not " + found_text(value_));
  const auto number = value_.get<double>();
  if (!std::isfinite(number)) fail("the number is not finite");
  return number;
}

double JsonPlace::not_negative() const {
  const double value = number();
  if (value < 0.0) fail(found_text(value_) + " is negative; give 0 or more");
  return value;
}

double JsonPlace::positive() const {
  const double value = number();
  if (value <= 0.0) fail(found_text(value_) + " is not above 0");
  return value;
}

Index JsonPlace::index() const {
  const double value = number();
  if (!value_.is_number_integer() || value < 0 || value > std::numeric_limits<Index>::max())
    fail("a whole number from 0 on is expected here, not " + found_text(value_));
  return static_cast<Index>(value);
}

Index JsonPlace::index_to(Index most) const {
  const Index value = index();
  if (value > most) fail(found_text(value_) + " is too much; give " + std::to_string(most) + " or less");
  return value;
}

std::string JsonPlace::text() const {
  if (!value_.is_string()) fail("a text is expected here");
  return value_.get<std::string>();
}

bool JsonPlace::truth() const {
  if (!value_.is_boolean()) fail("true or false is expected here, not " + found_text(value_));
  return value_.get<bool>();
}

std::size_t JsonPlace::choice(const std::vector<std::string>& words) const {
  if (!value_.is_string()) fail("one of " + joined(words) + " is expected here, not " + found_text(value_));
  const auto word = value_.get<std::string>();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string near = suggestion(word, words);
  fail(found_text(value_) + " is not known here" + (near.empty() ? "; the words are " + joined(words) : near));
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
  fail_at(name_, steps, message);
}

}  // namespace batten::io
