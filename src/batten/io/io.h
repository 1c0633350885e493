/// \file Meshes and points, from files and to files. The type follows the extension: .obj .ply .off .stl .xyz.
///
/// Readers keep every double bit for bit, polygons of any size, and what the file says about the surface (OpenSubdiv's
/// `t` tags in OBJ). They check the syntax: a bad token, a missing coordinate, an index out of range throws
/// Error(BadFile, IndexOutOfRange) with the file and the line (or the element, in binary files). Whether a surface can
/// be made of the faces is the business of Topology. Writers write to a temporary name in the same folder and rename
/// it, so that a failure leaves the old file as it was.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"

namespace batten {

/// Reads a mesh (XYZ: points without faces). "-" reads standard input and needs a format.
/// Throws Error(FileNotReadable, UnknownFormat, BadFile, IndexOutOfRange, NotFinite, TooLarge).
/// Cost: OBJ 250 MB/s, binary PLY 400 MB/s on two cores; memory: the file once, and the mesh.
Mesh read_mesh(const std::string& path, const std::string& format = "");

struct WriteOptions {
  std::string format;  ///< "obj", "ply", "off", "stl", "xyz"; empty: by the extension
  bool binary = true;  ///< PLY and STL: little-endian bytes; otherwise text with the shortest digits that read back
};

/// Writes what the format can hold (OBJ: all; PLY: points, faces, vertex attributes; OFF: points, faces; STL: triangles
/// only, polygons as fans, in float; XYZ: points). "-" writes to standard output. Throws Error(FileNotWritable,
/// UnknownFormat, NotFinite, BadShape).
void write_mesh(const std::string& path, const Mesh& mesh, const WriteOptions& options = {});

/// Calls write(temporary_path), then renames the temporary to path; removes the temporary when write throws or the
/// rename fails. The temporary stands in the same folder. Throws Error(FileNotWritable).
void write_atomically(const std::string& path, const std::function<void(const std::string&)>& write);

}  // namespace batten
