#include "fuzz/soup.h"

#include <algorithm>

#include "batten/mesh/primitives.h"

namespace batten::fuzz {

namespace {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  int next() { return at_ == end_ ? 0 : *at_++; }
  int below(int count) { return count > 0 ? next() % count : 0; }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

Mesh base_shape(int choice) {
  switch (choice) {
    case 1:
      return tetrahedron();
    case 2:
      return cube();
    case 3:
      return octahedron();
    case 4:
      return torus(4, 3);
    case 5:
      return grid(3, 2);
    case 6:
      return dodecahedron();
    default:
      return {};
  }
}

/// Mostly an existing vertex; 255 is none.
Index vertex(Bytes& bytes, const Mesh& mesh) {
  const int byte = bytes.next();
  return byte == 255 || mesh.vertex_count() == 0 ? -1 : static_cast<Index>(byte % mesh.vertex_count());
}

void add_points(Bytes& bytes, Mesh& mesh) {
  const Eigen::Index old = mesh.points.rows();
  mesh.points.conservativeResize(old + bytes.below(24), 3);
  mesh.points.bottomRows(mesh.points.rows() - old).setZero();
  // Sixteenths: coordinates often meet exactly, which is what welding and degenerate faces are about.
  for (double& x : mesh.points.reshaped<Eigen::RowMajor>()) x += (bytes.next() - 128) / 16.0;
}

void change_faces(Bytes& bytes, Mesh& mesh) {
  Mesh faces;
  const int dropped = bytes.next();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (f < 8 && (dropped >> f & 1) != 0) continue;
    faces.face_vertices.insert(faces.face_vertices.end(), mesh.face_vertices.begin() + mesh.face_offsets[f],
                               mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
    faces.face_offsets.push_back(static_cast<Index>(faces.face_vertices.size()));
  }
  mesh.face_vertices = std::move(faces.face_vertices);
  mesh.face_offsets = std::move(faces.face_offsets);
  for (int added = bytes.below(32); added > 0; --added) {
    for (int size = 3 + bytes.below(5) - (bytes.below(64) == 1 ? 2 : 0); size > 0; --size) {
      mesh.face_vertices.push_back(vertex(bytes, mesh));
    }
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
}

/// 0 to 12, so that some are infinite.
double sharpness(Bytes& bytes) { return bytes.below(49) / 4.0; }

void add_tags(Bytes& bytes, Mesh& mesh) {
  for (int count = bytes.below(16); count > 0; --count) {
    // Along a face, so that it is an edge.
    const auto corner = static_cast<std::size_t>(bytes.next()) + 1;
    if (corner >= mesh.face_vertices.size()) continue;
    mesh.creases.push_back({mesh.face_vertices[corner - 1], mesh.face_vertices[corner], sharpness(bytes)});
  }
  for (int count = bytes.below(8); count > 0; --count) mesh.corners.push_back({vertex(bytes, mesh), sharpness(bytes)});
  for (int count = bytes.below(4); count > 0; --count) mesh.holes.push_back(bytes.below(mesh.face_count()));
}

}  // namespace

Soup decode_soup(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  Soup soup;
  soup.mesh = base_shape(bytes.below(7));
  const int rules = bytes.next();
  soup.mesh.boundary = static_cast<BoundaryRule>(rules % 3);
  soup.mesh.crease_method = static_cast<CreaseMethod>(rules / 3 % 2);
  soup.mesh.triangle_rule = static_cast<TriangleRule>(rules / 6 % 2);
  soup.mesh.face_varying = static_cast<FaceVaryingRule>(rules / 12 % 6);
  soup.alpha = bytes.below(5) / 4.0;
  soup.cancel_at = std::max(bytes.next() - 192, 0);
  add_points(bytes, soup.mesh);
  change_faces(bytes, soup.mesh);
  add_tags(bytes, soup.mesh);
  return soup;
}

}  // namespace batten::fuzz
