/// \file The faces of a PLY file with their texture coordinates and texture numbers.
#pragma once
#include <string>
#include <vector>

#include "batten/io/faces.h"
#include "batten/io/ply_header.h"

namespace batten::io {

/// The face lists of MeshLab and of photogrammetry programs: u and v of each corner, and beside them, as with colours,
/// the exact numbers.
inline constexpr const char* kPlyUvs = "texcoord";
inline constexpr const char* kPlyExactUvs = "exact_texcoord";
/// The scalar that says which of the header's images a face shows, counted from 0.
inline constexpr const char* kPlyTextureNumber = "texnumber";

/// Lists of texture coordinates, as the faces come.
struct PlyUvs {
  Buffer<double> values;      ///< two for each corner of the faces that have a list of fitting length
  Buffer<std::uint8_t> fits;  ///< 1 for these faces; faces after the last entry have none
  std::int64_t unfit = 0;     ///< lists of another length that are not empty
  Buffer<double> row;         ///< of the face that is being read

  /// Ends the row of a face of `size` corners; `faces` came before it.
  void end_row(std::size_t faces, Index size);
};

/// Faces as a part of a reader collects them.
struct PlyFaces {
  static constexpr Index kNoTexture = -1;

  FaceList list;
  PlyUvs uvs;
  PlyUvs exact_uvs;
  Buffer<Index> textures;  ///< as `fits`, the number of each face's image

  /// Ends the row of the last face; what its properties are is said by the flags.
  void end_row(bool has_uvs, bool has_exact_uvs, bool has_texture, double texture);
};

/// What a PLY file says of all faces of a mesh.
class PlyFaceValues {
 public:
  /// Appends the faces of the parts to the mesh, keeps their values, and empties the parts. Throws Error(TooLarge).
  void join(const std::string& name, std::vector<PlyFaces>& parts, Mesh& mesh);

  /// Adds texture coordinates to the mesh, and a group `usemtl` with the name of its image for each run of faces.
  void move_to(const Source& source, const PlyHeader& header, Mesh& mesh);

 private:
  void move_uvs(const Source& source, Mesh& mesh);
  void move_textures(const Source& source, const std::vector<std::string>& images, Mesh& mesh) const;

  PlyUvs uvs_;
  PlyUvs exact_uvs_;
  Buffer<Index> textures_;
};

/// The images of a mesh's faces as PLY can name them.
struct PlyTextures {
  std::vector<std::string> names;  ///< relative to the file's folder
  Buffer<Index> numbers;           ///< of each face; empty if all faces show the only image, or if there is none
  bool complete = true;            ///< true if a reader gets the same materials
};
/// `file` is the name of the file that is written.
PlyTextures ply_textures(const std::string& file, const Mesh& mesh);

}  // namespace batten::io
