/// \file Meshes and points, from files and to files. The type follows the extension: .obj .ply .off .stl .xyz, and only
/// written .glb .usda.
///
/// Readers keep every double bit for bit, polygons of any size, and what the file says about the surface. They check
/// the syntax: a bad token, a missing coordinate, an index out of range throws an Error with the file and the line (in
/// binary files the element and the byte); of several wrong lines the first one, for any number of threads. A header
/// that promises more than the file can hold is refused before memory is taken. Whether a surface can be made of the
/// faces is the business of Topology.
///
///   OBJ  v (with w, which is skipped, or a colour: "color" where every vertex has one), vt, vn ("uv", "normal" at the
///        corners; of a file without faces at the vertices, where there is one for each), f with any corners, g o
///        usemtl s mtllib, and OpenSubdiv's tags `t crease`, `corner`, `hole`, `interpolateboundary`, `creasemethod`,
///        `smoothtriangles`, whose indices count from 0. All else is skipped. A group without a face is not kept.
///   PLY  text and both byte orders, any types. nx ny nz are "normal"; red green blue [alpha] "color" (bytes become
///   k/255);
///        s t, u v, texture_u texture_v "uv"; other scalars of the vertices one attribute each ("uv_" of a scalar uv).
///        Other elements are skipped.
///   OFF  with normals (N), colours (C) and texture coordinates (ST) of the vertices; no binary OFF, no other
///   dimensions. STL  text and bytes (told apart by the size of the file); equal coordinates become one vertex, in
///   order of appearance. XYZ  points: 3 columns, or 6 with "normal"; columns of another number are "extra". Blanks or
///   commas; # comments.
///
/// Coordinates and sharpnesses are finite; other attributes may hold NaN and come as the file has them.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"
#include "batten/output.h"

namespace batten {

/// Reads a mesh (XYZ: points without faces). "-" reads standard input and needs a format; pipes are read too.
/// format: one of the extensions; empty: by the extension of the path.
/// Throws Error(FileNotReadable, UnknownFormat, BadFile, IndexOutOfRange, NotFinite, TooLarge, Cancelled).
/// Cost: O(bytes), two cores: OBJ 800 MB/s, binary PLY 1500 MB/s, binary STL 200 MB/s. Memory: the mesh and the file;
/// OBJ twice the mesh and the file; from any file, however wrong, less than 64 times its size.
Mesh read_mesh(const std::string& path, const std::string& format = "", const Progress& progress = {});

/// The name of the format that a path and a wish stand for ("obj"): the wish, else the extension, in lower case and
/// without a dot. Throws Error(UnknownFormat).
std::string file_format(const std::string& path, const std::string& wish = "");

/// How to write.
struct WriteOptions {
  std::string format;  ///< "obj", "ply", "off", "stl", "xyz", "glb", "usda"; empty: by the extension
  bool binary = true;  ///< PLY and STL: little-endian bytes; otherwise text with the shortest digits that read back
};

/// Writes what the format can hold, in doubles that read back bit for bit.
///
///   OBJ   everything but attributes of other names than "uv", "normal" and (at the vertices) "color", and `scheme`
///   PLY   points, faces, attributes at the vertices (k columns of another name: NAME_0 and so on; colours of k/255 as
///         bytes)
///   OFF   points and faces
///   XYZ   points, and "normal" at the vertices
///   STL   triangles, polygons as fans; in bytes as float, which may bring close vertices together
///   GLB   triangles in float, for display: corners with equal "uv", "normal" and "color" share a vertex, v is turned
///         to point down, colours (taken as sRGB, in [0, 1]) become linear, a usemtl is a primitive with a material of
///         that name. Normals have unit length; missing and zero ones are the mean of the faces' by area. Holes are
///         left out. Coordinates stay as they are; where the points lie farther from the origin than their own size the
///         node has a translation, so that floats are enough. Takes the memory of the file twice besides the mesh.
///   USDA  a subdivision surface with all its tags, every attribute, usemtl as GeomSubsets; coordinates with all digits
///         of a double though USD's type is float, and a translation as in GLB. Polygons (subdivisionScheme "none")
///         with normals when the mesh has normals and nothing that speaks of a surface: no scheme, rule, tag or hole.
///
/// The old file stays as it was when anything fails (write_atomically). "-" writes to standard output.
/// Throws Error(FileNotWritable, UnknownFormat, Cancelled), and for a mesh that no reader would take NotFinite,
/// BadShape, IndexOutOfRange, DegenerateFace (fewer than three corners), BadArgument (a name with a line end, a
/// property twice, a coordinate beyond float, semi-sharp Chaikin creases in USDA), TooLarge (a GLB above 4 GiB),
/// NotAvailable (GLB in a build without tinygltf).
/// Cost: O(V + F); a few megabytes of memory besides the mesh.
void write_mesh(const std::string& path, const Mesh& mesh, const WriteOptions& options = {},
                const Progress& progress = {});

}  // namespace batten
