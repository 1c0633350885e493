/// \file The readers and writers behind read_mesh and write_mesh. Readers throw Error; `source` outlives the call.
#pragma once
#include "batten/io/source.h"
#include "batten/mesh/mesh.h"
#include "batten/mesh/morph_targets.h"
#include "batten/mesh/up_axis.h"
#include "batten/output.h"

namespace batten::io {

enum class Encoding { Text, Binary };

Mesh read_obj(const Source& source);
Mesh read_ply(const Source& source);
Mesh read_off(const Source& source);
Mesh read_stl(const Source& source);
Mesh read_xyz(const Source& source);
/// GLB and glTF; in builds with tinygltf (BATTEN_WITH_GLTF) only. Buffers in files of their own are read from the
/// folder of the source's name.
Mesh read_gltf(const Source& source);

/// The writers do not check the mesh: require_writable (write_check.h) must be called first.
/// `libraries` are the material files that the OBJ file names.
void write_obj(OutputFile& file, const Mesh& mesh, const std::vector<std::string>& libraries);
void write_ply(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment = {});
void write_off(OutputFile& file, const Mesh& mesh);
void write_stl(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment = {});
void write_xyz(OutputFile& file, const Mesh& mesh);
void write_vtk(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment = {});
/// Triangles in float. Throw Error(BadShape) for points without faces, BadArgument for numbers beyond those of floats.
void write_freesurfer(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment = {});
void write_gifti(OutputFile& file, const Mesh& mesh, Encoding encoding);
/// WriteOptions::up, or where it is Auto the guess.
inline UpAxis up_axis_to_write(const Mesh& mesh, UpAxis up) {
  return up == UpAxis::Auto ? guess_up_axis(mesh, UpAxis::Y) : up;
}
/// In builds with tinygltf (BATTEN_WITH_GLTF) only. targets: null, or targets that write_animation has checked.
void write_glb(OutputFile& file, const Mesh& mesh, UpAxis up, const MorphTargets* targets = nullptr);
/// True for numbers at vertices that glTF has no name for, and not more than four a vertex.
bool is_glb_own(const Attribute& attribute);
/// The name that glTF lets a program choose: "mean_curvature" is _MEAN_CURVATURE.
std::string glb_own_name(const std::string& name);
void write_usda(OutputFile& file, const Mesh& mesh, UpAxis up);
/// True for polygons that USDA holds as they are: a mesh with normals and without any choice about a subdivision
/// surface, and a mesh of the Butterflies, which USD does not know.
bool is_usda_polygonal(const Mesh& mesh);

}  // namespace batten::io
