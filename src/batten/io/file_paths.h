/// \file The paths of files that a mesh file names, such as images.
#pragma once
#include <string>

namespace batten::io {

/// The path of a file that `file` names relative to its own folder. Backslashes, as other systems write them, stand for
/// slashes where there is only such a file.
std::string path_named_in(const std::string& file, const std::string& name);

/// How `file` names the other file: relative to its own folder, with slashes. What is not in the file system, such as
/// standard output, names it as from the current folder.
std::string name_in(const std::string& file, const std::string& path);

}  // namespace batten::io
