/// \file A value in a JSON document that knows where it stands, so that an error can say so.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "batten/error.h"
#include "batten/types.h"

namespace batten::io {

using Json = nlohmann::ordered_json;

/// A key, or where it is empty a number in a list.
struct JsonStep {
  std::string key;
  std::size_t number = 0;
};

/// "forces[2].stiffness", from the steps that lead from the root. Empty at the root.
std::string path_text(const std::vector<JsonStep>& steps);

/// What errors call a document, and the places in it.
struct JsonName {
  std::string file;
  std::string kind = "document";  ///< "a scene is not so deep"
  std::string (*place_text)(const std::vector<JsonStep>& steps) = path_text;
};

/// The document. Throws Error(BadFile) "FILE: PLACE: ..." where the text is no JSON, gives a key twice, or is nested
/// more than 64 deep.
Json parse_json(const JsonName& name, std::string_view text);

/// The document as text: a value on one line where that is short, otherwise an entry a line. Ends in a line feed.
std::string json_text(const Json& document);

/// A view of a value; the document, its name, and the place that it was reached from, must outlive it.
class JsonPlace {
 public:
  JsonPlace(const JsonName& name, const Json& value) : name_(name), value_(value) {}

  /// A member of an object; throws where it is missing.
  JsonPlace at(const char* key) const;
  bool has(const char* key) const { return value_.is_object() && value_.contains(key); }
  /// An entry of a list.
  JsonPlace item(std::size_t number) const;
  /// The length of a list; throws where the value is none.
  std::size_t size() const;

  /// Throws where the value is no object, or has a key that is none of these; names the nearest one.
  void require_keys(const std::vector<std::string>& keys) const;

  bool is_number() const { return value_.is_number(); }
  bool is_list() const { return value_.is_array(); }
  bool is_object() const { return value_.is_object(); }
  bool is_text() const { return value_.is_string(); }
  double number() const;
  double not_negative() const;
  double positive() const;
  /// A whole number from 0 on that an Index can hold.
  Index index() const;
  /// The same, at most `most`.
  Index index_to(Index most) const;
  std::string text() const;
  bool truth() const;
  /// The number of the text among these words; throws for other words, naming the nearest one.
  std::size_t choice(const std::vector<std::string>& words) const;
  /// Three finite numbers.
  Eigen::Vector3d vector() const;
  /// The two numbers of a pair.
  Eigen::Vector2d pair() const;

  /// Throws Error(BadFile) "FILE: PLACE: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  JsonPlace(const JsonPlace& parent, const Json& value, const char* key, std::size_t number)
      : name_(parent.name_), value_(value), parent_(&parent), key_(key), number_(number) {}
  void require_list(std::size_t length) const;

  const JsonName& name_;
  const Json& value_;
  const JsonPlace* parent_ = nullptr;
  const char* key_ = "";
  std::size_t number_ = 0;
};

}  // namespace batten::io
