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
  MeshFile(Mesh mesh, UpAxis up, std::vector<std::string> notes = {}, Points origins = Points(0, 3))
      : mesh_(std::move(mesh)), up_(up), notes_(std::move(notes)), origins_(std::move(origins)) {}

  const Mesh& mesh() const { return mesh_; }
  /// True where the points are the ends of a medial model's spokes (medial/medial_boundary.h).
  bool is_medial() const { return origins_.rows() > 0; }
  UpAxis up() const { return up_; }

  /// {points, faceOffsets, faceVertices, creases (a, b, sharpness each), corners (vertex, sharpness each), notes,
  /// diagonal, up, triangles, scheme, origins}; origins: where the spokes of a medial model start, three numbers for
  /// each point, or none.
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
  /// The same for the surface as few faces as stay within `chord` of it (adaptive/adaptive.h), as the tool's --chord.
  val write_adaptive(const std::string& path, double chord) const;
  /// The same for the mesh as it is with normals (wanted_normals_of()) at its vertices, zeros where none is wanted.
  val write_normals(const std::string& path, const val& normals) const;

 private:
  val write_as(const std::string& path, const Mesh& written) const;

  Mesh mesh_;
  UpAxis up_;
  std::vector<std::string> notes_;
  Points origins_;
};

/// numbers: four each, a vertex and the direction wanted there. A row a vertex, or no rows where there is none.
Values wanted_normals_of(const val& numbers, Index vertices);

/// Reads a file of the engine's own file system: a MeshFile; of a medial model (.json) the mesh of its spokes' ends.
val read_mesh_file(const std::string& path, const val& report);

}  // namespace batten::studio
