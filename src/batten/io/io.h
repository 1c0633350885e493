/// \file Reads and writes meshes and points. The file type follows the extension: .obj .ply .off .stl .xyz
/// .glb, for reading only .gltf, for writing only .usda .vtk .fsb .gii. A gzip file, such as scan.ply.gz, is unpacked
/// while it is read.
///
/// Readers keep every double bit for bit, polygons of any size, and the file's choices about the surface. They check
/// the syntax: a bad token, a missing coordinate or an index out of range throws an Error that names the file and the
/// line (in binary files, the element and the byte). Of several wrong lines the first is reported, for any number of
/// threads. A header that promises more than the file can hold is refused before memory is allocated. Topology checks
/// whether the faces form a surface.
///
///   OBJ   v (a weight w is skipped; a colour becomes "color" if every vertex has one), vt, vn ("uv" and "normal" at
///         the corners, or at the vertices in a file without faces that has one for each), f with any number of
///         corners, g o usemtl s mtllib, and OpenSubdiv's tags `t crease`, `corner`, `hole`, `interpolateboundary`,
///         `creasemethod`, `smoothtriangles`, whose indices count from 0. All else is skipped. Groups without faces
///         are not kept.
///   PLY   text and both byte orders, any types, faces and strips (`tristrips`). nx ny nz become "normal"; red green
///         blue [alpha] "color" (bytes k/255; exact_red and so on instead, if the bytes agree); s t, u v, texture_u
///         texture_v and the faces' lists texcoord "uv"; images (TextureFile, texnumber) groups usemtl of their names;
///         any other scalar of the vertices an attribute ("uv_" for one called uv). Other elements are skipped.
///   OFF   with normals (N), colours (C) and texture coordinates (ST) of the vertices. Binary OFF and other
///         dimensions are not read.
///   STL   text and bytes, distinguished by the size of the file. Equal coordinates become one vertex, in the order
///         of appearance. If bytes follow the triangles, the attribute byte counts are taken at their word where they
///         add up to the size of the file; otherwise the rest is skipped.
///   XYZ   points in 3 columns, or 6 with "normal"; with another number, the further columns are "extra". Blanks or
///         commas separate numbers; # begins a comment.
///
///   GLB   and glTF 2.0: the triangles, strips and fans of the scene, moved by their nodes. Within a node, vertices
///         with equal coordinates become one; TEXCOORD_0 (v turned to point up), NORMAL and COLOR_0 (linear colours
///         become sRGB) become "uv", "normal" and "color", at the corners where a seam splits a vertex, otherwise at
///         the vertices. Nodes become groups o, materials usemtl; the file itself is the library of their colours
///         and images (Mesh::material_libraries). Draco and meshopt packing is refused.
///
/// Lines end in a line feed, with or without a carriage return, or in a carriage return alone.
/// Coordinates and sharpness values must be finite. Other attributes may hold NaN and are kept unchanged.
#pragma once
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/up_axis.h"
#include "batten/output.h"

namespace batten {

/// Reads a mesh (XYZ: points without faces). "-" reads standard input and needs a format; pipes can be read too.
/// format: one of the extensions, or empty for the path's extension.
/// Throws Error(FileNotReadable, UnknownFormat, BadFile, IndexOutOfRange, NotFinite, TooLarge, Cancelled).
/// Cost: O(bytes); on two cores OBJ 800 MB/s, binary PLY 1500 MB/s, binary STL 200 MB/s. Memory: the mesh and the file;
/// for OBJ twice the mesh and the file. A broken file never takes more than 64 times its size. The size of a gzip file
/// is that of its content here. Throws Error(NotAvailable) for one in a build without zlib.
/// notes: null, or gets a sentence ("NAME: ...") for everything that the file holds and the mesh does not, such as
/// skipped statements.
Mesh read_mesh(const std::string& path, const std::string& format = "", const Progress& progress = {},
               std::vector<std::string>* notes = nullptr);

/// The name of a file's format, such as "obj": `wish` if given, otherwise the path's extension, in lower case and
/// without a dot; that before a .gz. Throws Error(UnknownFormat).
std::string file_format(const std::string& path, const std::string& wish = "");

/// The up axis of a mesh from a file of this format (a name of file_format): Y for glb and gltf, whose format says so.
/// Otherwise guess_up_axis, with the axis that the format's programs mostly use as the usual one: Y for obj, ply and
/// off, Z for stl and xyz.
UpAxis find_up_axis(const Mesh& mesh, const std::string& format);

/// Options of write_mesh.
struct WriteOptions {
  /// "obj", "ply", "off", "stl", "xyz", "glb", "usda", "vtk", "fsb", "gii"; empty for the path's extension
  std::string format;
  /// PLY, STL, VTK, FreeSurfer's format and GIFTI: bytes; otherwise text with the fewest digits that read back exactly.
  bool binary = true;
  /// GLB and USDA: the mesh's up axis. Auto: find_up_axis without a format, that is guess_up_axis(mesh, UpAxis::Y).
  UpAxis up = UpAxis::Y;
  /// A line for other programs in OBJ, PLY, STL (there in the header's 80 bytes), VTK and FreeSurfer's format, such as
  /// "SPACE=RAS"; without a line end.
  std::string comment = {};
};

/// Writes everything that the format can hold, as doubles that read back bit for bit.
///
///   OBJ   everything except `scheme` and attributes with names other than "uv", "normal" and "color" (vertices). Base
///         colours and images of glTF libraries go to mesh.mtl and image files beside mesh.obj; no file is replaced
///         but a material file that Batten wrote: where another one is in the way, the name gets a number (wood-2.png)
///   PLY   points, faces, attributes at the vertices (k columns: NAME_0 and so on), "uv" at corners, images. Colours
///         are bytes and texcoord floats, as others expect; if these are not exact, doubles called exact_red,
///         exact_texcoord and so on follow
///   OFF   points and faces
///   XYZ   points, and "normal" at the vertices
///   STL   triangles, polygons as fans; bytes hold floats, in which vertices close to each other may coincide
///   GLB   triangles in float, for display: corners with equal "uv", "normal" and "color" share a vertex, v is turned
///         to point down, colours (taken as sRGB, in [0, 1]) become linear, and each usemtl is a primitive with a
///         material; base colours and images are those of the libraries. Normals have unit length; missing and zero
///         ones are the mean of the faces' by area. Holes are left out. glTF has y up and the front at +z: a mesh with
///         another up axis is turned so (to_y_up), which changes no digit. If the points are farther from the origin
///         than their own size, the node has a translation, so that floats are precise enough. Takes twice the memory
///         of the file besides the mesh.
///   USDA  a subdivision surface with all its tags, every attribute, and usemtl as GeomSubsets. Coordinates have all
///         digits of a double although USD's type is float, and a translation as in GLB. upAxis is Y or Z; for the
///         other axes a transform turns the mesh to Y. A mesh with normals and without any choice about a surface
///         (scheme, rule, tag or hole) is written as polygons (subdivisionScheme "none").
///   VTK   points in double and faces, as legacy polydata of version 3.0
///   FSB   a surface of FreeSurfer's, whose names have no extensions: triangles in float (with text its ascii variant)
///   GII   GIFTI: triangles in float, in the space of the scanner, which is RAS there
///
/// If anything fails, an existing file stays unchanged (write_atomically). "-" writes to standard output.
/// Throws Error(FileNotWritable, UnknownFormat (also for .gz), Cancelled), and for a mesh that no reader would accept
/// NotFinite, BadShape, IndexOutOfRange, DegenerateFace (fewer than three corners), BadArgument (a name with a line
/// end, a repeated property, a coordinate outside the range of float, semi-sharp Chaikin creases in USDA), TooLarge (a
/// GLB above 4 GiB), NotAvailable (GLB in a build without tinygltf). Cost: O(V + F); a few megabytes of memory besides
/// the mesh.
void write_mesh(const std::string& path, const Mesh& mesh, const WriteOptions& options = {},
                const Progress& progress = {});

}  // namespace batten
