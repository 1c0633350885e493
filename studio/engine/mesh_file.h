/// \file A mesh of the page: read, looked at, repaired, written.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/up_axis.h"
#include "studio/engine/arrays.h"

namespace batten::studio {

/// Keeps all that a file holds, of which the page sees points, faces and tags.
class MeshFile {
 public:
  /// up: of the file that the mesh came from (find_up_axis()).
  MeshFile(Mesh mesh, UpAxis up, std::vector<std::string> notes = {})
      : mesh_(std::move(mesh)), up_(up), notes_(std::move(notes)) {}

  const Mesh& mesh() const { return mesh_; }
  UpAxis up() const { return up_; }

  /// {points, faceOffsets, faceVertices, creases (a, b, sharpness each), corners (vertex, sharpness each), notes,
  /// diagonal, up, triangles, scheme}.
  val contents() const;
  /// [{code, count, messages, places}]: why there is no surface; places: points near the elements named.
  val problems() const;
  val set_points(const val& points);
  /// creases, corners: as in contents().
  val set_tags(const val& creases, const val& corners);
  /// {mesh, changes: [sentence]}.
  val repaired(double weld) const;
  /// Writes a file of the engine's own file system. {losses: [words]}.
  val write(const std::string& path, int levels) const;
  /// The same for the mesh as it is with normals (wanted_normals_of()) at its vertices, zeros where none is wanted.
  val write_normals(const std::string& path, const val& normals) const;

 private:
  Mesh mesh_;
  UpAxis up_;
  std::vector<std::string> notes_;
};

/// numbers: four each, a vertex and the direction wanted there. A row a vertex, or no rows where there is none.
Values wanted_normals_of(const val& numbers, Index vertices);

/// Reads a file of the engine's own file system: a MeshFile.
val read_mesh_file(const std::string& path, const val& report);

}  // namespace batten::studio
