#include <Eigen/Geometry>
#include <limits>

#include "batten/error.h"
#include "batten/io/bytes.h"
#include "batten/io/formats.h"
#include "batten/io/text_output.h"

namespace batten::io {

namespace {

/// Calls body(normal, corners) for each triangle of the fan around the face's first corner.
template <typename Body>
void for_each_triangle(const Mesh& mesh, Index face, const Body& body) {
  const Index first = mesh.face_offsets[face];
  for (Index corner = first + 1; corner + 1 < mesh.face_offsets[face + 1]; ++corner) {
    Eigen::Matrix3d points;
    points.row(0) = mesh.points.row(mesh.face_vertices[first]);
    points.row(1) = mesh.points.row(mesh.face_vertices[corner]);
    points.row(2) = mesh.points.row(mesh.face_vertices[corner + 1]);
    const Eigen::Vector3d cross = (points.row(1) - points.row(0)).cross(points.row(2) - points.row(0)).transpose();
    body(Eigen::Vector3d(cross.stableNormalized()), points);
  }
}

void write_binary(OutputFile& file, const Mesh& mesh, const std::string& comment) {
  // A header that begins with "solid" would look like text.
  std::string header = "binary STL, written by Batten";
  if (!comment.empty()) header += ", " + comment;
  header.resize(80, ' ');
  const std::size_t triangles = mesh.face_vertices.size() - 2 * static_cast<std::size_t>(mesh.face_count());
  ByteBuffer count;
  count.put(static_cast<std::uint32_t>(triangles));
  file.write(header);
  file.write(count.text());
  write_rows<ByteBuffer>(file, mesh.face_count(), [&](ByteBuffer& out, std::ptrdiff_t face) {
    for_each_triangle(mesh, static_cast<Index>(face),
                      [&](const Eigen::Vector3d& normal, const Eigen::Matrix3d& points) {
                        for (int k = 0; k < 3; ++k) out.put(static_cast<float>(normal[k]));
                        for (int i = 0; i < 9; ++i) out.put(static_cast<float>(points(i / 3, i % 3)));
                        out.put(std::uint16_t{0});
                      });
  });
}

void write_text(OutputFile& file, const Mesh& mesh, const std::string& comment) {
  file.write("solid batten" + (comment.empty() ? "" : " " + comment) + "\n");
  write_rows<TextBuffer>(file, mesh.face_count(), [&](TextBuffer& out, std::ptrdiff_t face) {
    for_each_triangle(mesh, static_cast<Index>(face),
                      [&](const Eigen::Vector3d& normal, const Eigen::Matrix3d& points) {
                        out.put("facet normal").put_row(normal).put("\nouter loop\n");
                        for (int i = 0; i < 3; ++i) out.put("vertex").put_row(points.row(i)).put('\n');
                        out.put("endloop\nendfacet\n");
                      });
  });
  file.write("endsolid batten\n");
}

}  // namespace

void write_stl(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment) {
  if (mesh.face_count() == 0 && mesh.vertex_count() > 0) {
    throw Error(ErrorCode::BadShape,
                file.name() + ": STL holds triangles only, and the mesh has no face; write xyz or ply");
  }
  file.expect_rows(mesh.face_count());
  if (encoding == Encoding::Text) {
    write_text(file, mesh, comment);
    return;
  }
  const bool fits = mesh.vertex_count() == 0 || mesh.points.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max();
  if (!fits) {
    throw Error(ErrorCode::BadArgument,
                file.name() + ": a coordinate is too large for the floats of binary STL; scale it");
  }
  write_binary(file, mesh, comment);
}

}  // namespace batten::io
