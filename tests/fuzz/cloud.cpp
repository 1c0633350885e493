/// Fuzz target of first meshes: any few points give a mesh that Topology accepts, with the parts that are reported, or
/// an Error with a reason; the order of the points does not matter.
#include <array>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/topology.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

/// Takes byte after byte; zeros where there are no more.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  int take() { return at_ < size_ ? data_[at_++] : 0; }
  std::size_t left() const { return size_ - at_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

/// A point from three bytes: anywhere on a grid, or on a ball or a ring that most bytes lie on.
Eigen::RowVector3d point_of(int shape, int a, int b, int c) {
  if (shape == 0) return Eigen::RowVector3d(a, b, c) / 16.0;
  const double u = a * 0.0245437;
  const double v = b * 0.0245437;
  const double off = 1.0 + (c > 240 ? 0.2 * (c - 240) : 1e-3 * c);
  if (shape == 1) return off * Eigen::RowVector3d(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v));
  if (shape == 2)
    return {(2.0 + off * std::cos(v)) * std::cos(u), (2.0 + off * std::cos(v)) * std::sin(u), off * std::sin(v)};
  return {a / 64.0, b / 64.0, c > 250 ? 0.1 * c : 0.0};
}

struct FuzzCloud {
  PointCloud cloud;
  FirstMeshOptions options;
};

FuzzCloud decode_cloud(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  FuzzCloud made;
  const int kind = bytes.take();
  made.options.faces = (kind & 1) != 0 ? FaceKind::Triangles : FaceKind::Quads;
  made.options.pattern = (kind & 2) != 0 ? QuadPattern::Grid : QuadPattern::Adapted;
  if ((kind & 4) != 0) made.options.genus = bytes.take() % 4;
  if ((kind & 8) != 0) made.options.bridge = bytes.take() / 8.0;
  made.options.vertices = 8 + bytes.take();
  const int shape = kind >> 4 & 3;
  const bool has_normals = (kind & 64) != 0;
  constexpr std::array<double, 6> kScales{1.0, 1.0, 1e-300, 1e300, 1e-9, 1e9};
  const double scale = (kind & 128) != 0 ? kScales[bytes.take() % 6] : 1.0;
  // Each triple of bytes stands for three points, so that few bytes make a surface.
  const auto count = static_cast<Index>(bytes.left() / 3);
  made.cloud.points.resize(3 * count, 3);
  for (Index i = 0; i < count; ++i) {
    const int a = bytes.take();
    const int b = bytes.take();
    const int c = bytes.take();
    made.cloud.points.row(3 * i) = scale * point_of(shape, a, b, c);
    made.cloud.points.row(3 * i + 1) = scale * point_of(shape, (a + 85) % 256, (b * 7 + 31) % 256, c);
    made.cloud.points.row(3 * i + 2) = scale * point_of(shape, (a * 5 + 170) % 256, (b + 100) % 256, c);
    if (a == 255 && c == 255) made.cloud.points(3 * i, 1) = std::numeric_limits<double>::quiet_NaN();
  }
  if (has_normals) made.cloud.normals = made.cloud.points / scale;
  return made;
}

void check_mesh(const FirstMesh& found) {
  require(found.mesh.points.allFinite(), "points that are not finite");
  const MeshSummary summary = summarize(Topology(found.mesh));
  require(summary.isolated_vertices == 0, "a vertex without a face");
  require(summary.components.size() == found.parts.size(), "other parts than those reported");
  for (std::size_t i = 0; i < found.parts.size(); ++i) {
    require(summary.components[i].genus() == found.parts[i].genus, "another genus than the one reported");
    require(summary.components[i].boundary_loops == found.parts[i].boundary_loops, "other boundaries than reported");
  }
}

void run(const FuzzCloud& made) {
  FirstMesh found;
  try {
    found = first_mesh(made.cloud, made.options);
  } catch (const Error& error) {
    require(error.what()[0] != '\0', "an error without words");
    return;
  }
  check_mesh(found);
  if (made.options.genus) require(found.genus() == *made.options.genus, "another genus than the one asked for");
  PointCloud reversed{made.cloud.points.colwise().reverse(), made.cloud.normals.colwise().reverse()};
  require(first_mesh(reversed, made.options).mesh.points == found.mesh.points, "the order of points matters");
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::run(batten::fuzz::decode_cloud(data, size));
  return 0;
}
