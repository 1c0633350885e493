/// \file The material file and the images beside an OBJ file, for materials that a glTF file describes.
#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "batten/io/materials.h"

namespace batten::io {

/// Chooses names when it is made, and writes nothing before write(). For mesh.obj the material file is mesh.mtl, and an
/// image has the name that it has in the glTF file. A file with another content is never replaced, except a material
/// file that Batten wrote: the next free name is taken (wood-2.png), and an image that is there already is used.
class ObjLibrary {
 public:
  /// `path` is that of the OBJ file; nothing is written beside standard output, devices and pipes.
  ObjLibrary(const std::string& path, const Mesh& mesh);

  /// The libraries that the OBJ file names: those of the mesh, with the material file in the place of glTF files.
  const std::vector<std::string>& libraries() const { return libraries_; }

  /// Writes the material file and the images. Throws Error(FileNotWritable), and leaves no new file behind then.
  void write() const;

 private:
  void add_material(const std::string& name, const Material& material);
  /// The name in the folder for a new file of these bytes, which begins with stem and ends in extension.
  std::string choose_name(const std::string& stem, const std::string& extension, const std::string& bytes);

  std::string path_;
  std::string text_;  ///< of the material file
  std::string name_;  ///< of the material file; empty if there is none
  std::vector<std::string> libraries_;
  std::set<std::string> taken_;
  std::map<std::string, std::shared_ptr<const std::string>> images_;  ///< by file name
};

}  // namespace batten::io
