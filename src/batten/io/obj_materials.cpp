/// OBJ's material files.
#include <fast_float/fast_float.h>

#include <algorithm>

#include "batten/io/file_paths.h"
#include "batten/io/materials.h"

namespace batten::io {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  text = trimmed(text.substr(word.size()));
  return word;
}

bool read_number(std::string_view word, double& value) {
  const fast_float::from_chars_result result = fast_float::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc() && result.ptr == word.data() + word.size();
}

/// The file name after the options of a map, such as `-s 2 2 1 -clamp on wood.png`. It may hold blanks.
std::string_view map_file(std::string_view text) {
  static const std::map<std::string_view, int> number_counts = {{"-o", 3}, {"-s", 3}, {"-t", 3}, {"-mm", 2}};
  while (!text.empty() && text.front() == '-') {
    std::string_view rest = text;
    const std::string_view option = take_word(rest);
    const auto numbers = number_counts.find(option);
    if (numbers == number_counts.end()) {
      take_word(rest);
    } else {
      for (int i = 0; i < numbers->second; ++i) {
        std::string_view after = rest;
        double number = 0.0;
        if (!read_number(take_word(after), number)) break;
        rest = after;
      }
    }
    text = rest;
  }
  return text;
}

double in_unit_range(double value) { return value >= 0.0 ? std::min(value, 1.0) : 0.0; }

void read_color(std::string_view text, Material& material) {
  double grey = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double value = 0.0;
    if (!read_number(take_word(text), value)) value = grey;  // g and b may be left out
    if (k == 0) grey = value;
    material.color[k] = in_unit_range(value);
  }
}

/// Reads a line of the material that is at hand, which a line `newmtl` replaces.
void read_statement(const std::string& path, std::string_view line, Materials& materials, Material*& material) {
  const std::string_view keyword = take_word(line);
  if (keyword == "newmtl") {
    const auto added = materials.emplace(std::string(line), Material());
    material = added.second ? &added.first->second : nullptr;
    return;
  }
  if (material == nullptr) return;
  double number = 0.0;
  if (keyword == "Kd" && line.substr(0, 8) != "spectral" && line.substr(0, 3) != "xyz") {
    read_color(line, *material);
  } else if (keyword == "d" && read_number(take_word(line), number)) {
    material->color[3] = in_unit_range(number);
  } else if (keyword == "Tr" && read_number(take_word(line), number)) {
    material->color[3] = 1.0 - in_unit_range(number);
  } else if (keyword == "map_Kd") {
    const std::string_view file = map_file(line);
    if (!file.empty()) material->texture = path_named_in(path, std::string(file));
  }
}

}  // namespace

void read_obj_materials(const std::string& path, std::string_view text, Materials& materials) {
  Material* material = nullptr;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') read_statement(path, content, materials, material);
  }
}

}  // namespace batten::io
