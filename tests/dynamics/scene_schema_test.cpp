/// models/scene.schema.json, which editors use, has the keys and the words that the reader of scenes has.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "batten/dynamics/scene.h"
#include "batten/error.h"
#include "support/source_folder.h"

namespace batten {
namespace {

using SchemaWords = std::set<std::string>;

nlohmann::json read_schema() {
  std::ifstream file(test::source_folder() + "/models/scene.schema.json");
  return nlohmann::json::parse(file);
}

/// What the reader would know in the place of @, which is a key or a word that it does not.
SchemaWords known_instead(std::string scene) {
  scene = std::regex_replace(scene, std::regex("@"), "zzzzzzzzzzzz");
  std::string message;
  try {
    parse_scene("s", scene);
  } catch (const Error& error) {
    message = error.what();
  }
  std::smatch list;
  SchemaWords words;
  if (!std::regex_search(message, list, std::regex("the (?:keys|words) are (.*)"))) {
    ADD_FAILURE() << scene << "\n" << message;
    return words;
  }
  const std::string text = list[1];
  const std::regex word("[^, ]+");
  for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it) words.insert((*it)[0]);
  return words;
}

SchemaWords keys_at(const nlohmann::json& schema, const std::string& pointer) {
  SchemaWords keys;
  for (const auto& entry : schema.at(nlohmann::json::json_pointer(pointer + "/properties")).items())
    keys.insert(entry.key());
  return keys;
}

struct SchemaObject {
  const char* pointer;
  const char* scene;
};

TEST(SceneSchema, HasTheKeysThatTheReaderKnows) {
  const nlohmann::json schema = read_schema();
  const SchemaObject objects[] = {
      {"", R"({"@": 1})"},
      {"/properties/start", R"({"mesh": "m", "start": {"@": 1}})"},
      {"/properties/material/oneOf/1", R"({"mesh": "m", "material": {"@": 1}})"},
      {"/properties/rest", R"({"mesh": "m", "rest": {"@": 1}})"},
      {"/properties/time", R"({"mesh": "m", "time": {"@": 1}})"},
      {"/properties/time/properties/rest", R"({"mesh": "m", "time": {"rest": {"@": 1}}})"},
      {"/properties/time/properties/refine/oneOf/1", R"({"mesh": "m", "time": {"refine": {"@": 1}}})"},
      {"/properties/output", R"({"mesh": "m", "output": {"@": 1}})"}};
  for (const SchemaObject& object : objects) EXPECT_EQ(keys_at(schema, object.pointer), known_instead(object.scene));
}

TEST(SceneSchema, HasTheKeysOfEachForceAndSupport) {
  const nlohmann::json schema = read_schema();
  for (const char* list : {"force", "support"}) {
    SchemaWords types;
    for (const nlohmann::json& kind : schema.at("definitions").at(list).at("oneOf")) {
      const std::string type = kind.at("properties").at("type").at("const");
      types.insert(type);
      SchemaWords keys;
      for (const auto& entry : kind.at("properties").items()) keys.insert(entry.key());
      const std::string scene =
          R"({"mesh": "m", ")" + std::string(list) + R"(s": [{"type": ")" + type + R"(", "@": 1}]})";
      EXPECT_EQ(keys, known_instead(scene)) << type;
    }
    EXPECT_EQ(types, known_instead(R"({"mesh": "m", ")" + std::string(list) + R"(s": [{"type": "@"}]})"));
  }
}

TEST(SceneSchema, HasTheWordsOfEachChoice) {
  const nlohmann::json schema = read_schema();
  const SchemaObject choices[] = {{"/properties/scheme", R"({"mesh": "m", "scheme": "@"})"},
                                  {"/properties/boundary", R"({"mesh": "m", "boundary": "@"})"},
                                  {"/properties/material/oneOf/0", R"({"mesh": "m", "material": "@"})"},
                                  {"/properties/rest/properties/model", R"({"mesh": "m", "rest": {"model": "@"}})"},
                                  {"/properties/rest/properties/measure", R"({"mesh": "m", "rest": {"measure": "@"}})"},
                                  {"/properties/time/properties/scheme", R"({"mesh": "m", "time": {"scheme": "@"}})"},
                                  {"/properties/time/properties/solver", R"({"mesh": "m", "time": {"solver": "@"}})"},
                                  {"/properties/output/properties/up", R"({"mesh": "m", "output": {"up": "@"}})"}};
  for (const SchemaObject& choice : choices) {
    SchemaWords words;
    for (const auto& word : schema.at(nlohmann::json::json_pointer(std::string(choice.pointer) + "/enum")))
      words.insert(word.get<std::string>());
    EXPECT_EQ(words, known_instead(choice.scene)) << choice.pointer;
  }
}

}  // namespace
}  // namespace batten
