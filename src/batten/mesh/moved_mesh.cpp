#include "batten/mesh/moved_mesh.h"

#include <algorithm>
#include <string>
#include <vector>

#include "batten/error.h"

namespace batten {

namespace {

std::string face_text(const Mesh& mesh, Index face) {
  std::string text;
  for (Index i = mesh.face_offsets[face]; i < mesh.face_offsets[face + 1]; ++i) {
    text += (text.empty() ? "" : " ") + std::to_string(mesh.face_vertices[i]);
  }
  return text;
}

/// True if both faces have the same corners in the same order, from any first corner.
bool same_face(const Mesh& a, const Mesh& b, Index face) {
  const Index size = a.face_size(face);
  if (b.face_size(face) != size) return false;
  const Index* ours = a.face_vertices.data() + a.face_offsets[face];
  const Index* theirs = b.face_vertices.data() + b.face_offsets[face];
  for (Index turn = 0; turn < size; ++turn) {
    if (theirs[turn] == ours[0] && std::equal(ours, ours + size - turn, theirs + turn) &&
        std::equal(ours + size - turn, ours + size, theirs)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Mesh with_points(const Mesh& mesh, ConstValuesRef points) {
  if (points.rows() != mesh.points.rows() || points.cols() != 3) {
    throw Error(ErrorCode::BadShape, "there must be one point of three coordinates for each of the mesh's " +
                                         std::to_string(mesh.points.rows()) + " vertices");
  }
  Mesh moved = mesh;
  moved.points = points;
  std::erase_if(moved.attributes, [](const Attribute& attribute) { return attribute.name == "normal"; });
  return moved;
}

void require_same_connectivity(const Mesh& a, const Mesh& b) {
  const std::string wanted = "; both must have the same faces over the same vertices";
  if (a.vertex_count() != b.vertex_count()) {
    throw Error(ErrorCode::BadShape, "the first mesh has " + std::to_string(a.vertex_count()) +
                                         " vertices and the second " + std::to_string(b.vertex_count()) + wanted);
  }
  if (a.face_count() != b.face_count()) {
    throw Error(ErrorCode::BadShape, "the first mesh has " + std::to_string(a.face_count()) + " faces and the second " +
                                         std::to_string(b.face_count()) + wanted);
  }
  for (Index f = 0; f < a.face_count(); ++f) {
    if (same_face(a, b, f)) continue;
    throw Error(ErrorCode::BadShape, "face " + std::to_string(f) + " joins the vertices " + face_text(a, f) +
                                         " of the first mesh and " + face_text(b, f) + " of the second" + wanted);
  }
}

}  // namespace batten
