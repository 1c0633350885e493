/// \file What a file says.
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace batten::cli_tests {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace batten::cli_tests
