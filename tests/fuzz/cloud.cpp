/// Fuzz target of first meshes: any few points give a mesh that Topology accepts, with the parts that are reported, or
/// an Error with a reason; the order of the points does not matter.
#include "batten/error.h"
#include "batten/fit/first_mesh.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/topology.h"
#include "fuzz/few_points.h"
#include "fuzz/memory.h"

namespace batten::fuzz {
namespace {

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
  made.cloud = few_points(kind, bytes, bytes.left());
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
  require(first_mesh(reversed(made.cloud), made.options).mesh.points == found.mesh.points,
          "the order of points matters");
}

}  // namespace
}  // namespace batten::fuzz

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  batten::fuzz::run(batten::fuzz::decode_cloud(data, size));
  return 0;
}
