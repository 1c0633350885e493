#include "batten/io/file_paths.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "batten/output.h"

namespace batten::io {

namespace fs = std::filesystem;

std::string path_named_in(const std::string& file, const std::string& name) {
  const fs::path folder = fs::path(file).parent_path();
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code error;
  const bool only_slashes = slashes != name && !fs::exists(folder / name, error) && fs::exists(folder / slashes, error);
  return (folder / (only_slashes ? slashes : name)).lexically_normal().string();
}

std::string name_in(const std::string& file, const std::string& path) {
  std::error_code error;
  const fs::path folder =
      fs::absolute(is_special_target(file) ? fs::path("file") : fs::path(file), error).parent_path();
  if (error) return path;
  const fs::path other = fs::absolute(path, error);
  if (error) return path;
  const fs::path relative = other.lexically_normal().lexically_relative(folder.lexically_normal());
  return relative.empty() ? path : relative.generic_string();
}

}  // namespace batten::io
