/// \file A mesh of the page: read, looked at, repaired, written.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"
#include "studio/engine/arrays.h"

namespace batten::studio {

/// Keeps all that a file holds, of which the page sees points, faces and tags.
class MeshFile {
 public:
  explicit MeshFile(Mesh mesh, std::vector<std::string> notes = {})
      : mesh_(std::move(mesh)), notes_(std::move(notes)) {}

  const Mesh& mesh() const { return mesh_; }

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

 private:
  Mesh mesh_;
  std::vector<std::string> notes_;
};

/// Reads a file of the engine's own file system: a MeshFile.
val read_mesh_file(const std::string& path, const val& report);

}  // namespace batten::studio
