#include "batten/io/usda_text.h"

namespace batten::io {

std::string usda_identifier(const std::string& text, std::set<std::string>& taken) {
  std::string name;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    const bool digit = c >= '0' && c <= '9';
    if (name.empty() && digit) name = "_";
    name += letter || digit ? c : '_';
  }
  if (name.empty()) name = "_";
  std::string candidate = name;
  for (int number = 1; !taken.insert(candidate).second; ++number) candidate = name + "_" + std::to_string(number);
  return candidate;
}

}  // namespace batten::io
