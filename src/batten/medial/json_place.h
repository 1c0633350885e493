/// \file A value in a JSON document that knows where it stands, so that an error can say so.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "batten/error.h"
#include "batten/types.h"

namespace batten::medial {

using Json = nlohmann::ordered_json;

/// A key, or where it is empty a number in a list.
struct JsonStep {
  std::string key;
  std::size_t number = 0;
};

/// "line 3, step 1, UpSpoke, Direction", from the steps that lead from the root. Empty at the root.
std::string place_text(const std::vector<JsonStep>& steps);

/// The document. Throws Error(BadFile) "NAME: PLACE: ..." where the text is no JSON, or is nested
/// deeper than any model.
Json parse_json(const std::string& name, std::string_view text);

/// The document as text: a value on one line where that is short, otherwise an entry a line. Ends in a line feed.
std::string json_text(const Json& document);

/// A view of a value; the document, and the place that it was reached from, must outlive it.
class JsonPlace {
 public:
  JsonPlace(const std::string& file, const Json& value) : file_(file), value_(value) {}

  /// A member of an object; throws where it is missing.
  JsonPlace at(const char* key) const;
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  /// An entry of a list.
  JsonPlace item(std::size_t number) const;
  /// The length of a list; throws where the value is none.
  std::size_t size() const;

  bool is_list() const { return value_.is_array(); }
  bool is_object() const { return value_.is_object(); }
  bool is_text() const { return value_.is_string(); }
  double number() const;
  /// A whole number from 0 on that an Index can hold.
  Index index() const;
  std::string text() const;
  /// Three finite numbers.
  Eigen::Vector3d vector() const;
  /// The two numbers of a pair.
  Eigen::Vector2d pair() const;

  /// Throws Error(BadFile) "FILE: PLACE: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  JsonPlace(const JsonPlace& parent, const Json& value, const char* key, std::size_t number)
      : file_(parent.file_), value_(value), parent_(&parent), key_(key), number_(number) {}
  void require_list(std::size_t length) const;

  const std::string& file_;
  const Json& value_;
  const JsonPlace* parent_ = nullptr;
  const char* key_ = "";
  std::size_t number_ = 0;
};

}  // namespace batten::medial
