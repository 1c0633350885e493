#include <cctype>

#include "batten/io/formats.h"

namespace batten::io {

bool is_glb_own(const Attribute& attribute) {
  constexpr Eigen::Index kMostColumns = 4;
  const bool named = attribute.name == "normal" || attribute.name == "uv" || attribute.name == "color";
  const Eigen::Index columns = attribute.values.cols();
  return !named && !attribute.per_corner() && columns >= 1 && columns <= kMostColumns;
}

std::string glb_own_name(const std::string& name) {
  std::string own = "_";
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    own += std::isalnum(byte) != 0 ? static_cast<char>(std::toupper(byte)) : '_';
  }
  return own;
}

}  // namespace batten::io
