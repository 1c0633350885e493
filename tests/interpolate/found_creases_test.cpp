/// Creases that are found by angle, then interpolated. Thall 2002 (section 2.7) expects artifacts where vertices and
/// edges of iterated control meshes are frozen; here creases are part of the equations.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "batten/expand/features.h"
#include "batten/interpolate/interpolator.h"
#include "batten/io/io.h"
#include "batten/mesh/face_normal.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"
#include "support/source_folder.h"

namespace batten {
namespace {

using test::kCatmullClark;

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

/// Both sides of one end of a crease that does not stop there.
struct CreaseEnd {
  double given;    ///< between the faces, in degrees
  double reached;  ///< between the limit normals
};

struct FoundCreases {
  std::size_t count = 0;
  std::vector<CreaseEnd> ends;
  double max_error = 0.0;  ///< of the points, of the diagonal
};

FoundCreases interpolate_with_found(Mesh mesh) {
  const std::vector<Crease> found = find_features(Topology(mesh), mesh.points, {40.0});
  mesh.creases.insert(mesh.creases.end(), found.begin(), found.end());
  const Topology topology(mesh);
  const Interpolant result = Interpolator(topology, kCatmullClark).solve(mesh.points);
  const Values normals = limit_normals(topology, kCatmullClark, result.control).corners;
  const auto is_sharp_edge = [&](Index h) { return topology.edge_sharpness(topology.edge(h)) >= kInfiniteSharpness; };
  const auto stops_at = [&](Index v) {
    int sharp = 0;
    topology.for_each_outgoing(v, [&](Index h) { sharp += is_sharp_edge(h) ? 1 : 0; });
    return sharp < 2;
  };
  FoundCreases creases{found.size(), {}, result.report.max_error / result.report.diagonal};
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    const Index twin = topology.twin(h);
    if (twin < 0 || !is_sharp_edge(h) || stops_at(topology.origin(h))) continue;
    const auto face = [&](Index i) { return face_normal(topology, mesh.points, topology.face(i)); };
    creases.ends.push_back({degrees_between(face(h), face(twin)),
                            degrees_between(normals.row(h).transpose(), normals.row(topology.next(twin)).transpose())});
  }
  return creases;
}

double mean_change(const FoundCreases& creases) {
  double sum = 0.0;
  for (const CreaseEnd& end : creases.ends) sum += std::abs(end.reached - end.given);
  return sum / static_cast<double>(creases.ends.size());
}

/// Of the ends, those where the surface turns by more than half of what the faces do.
double share_kept(const FoundCreases& creases) {
  const auto kept = std::count_if(creases.ends.begin(), creases.ends.end(),
                                  [](const CreaseEnd& end) { return end.reached > 0.5 * end.given; });
  return static_cast<double>(kept) / static_cast<double>(creases.ends.size());
}

/// Closed form: flat sides are reproduced, so that the sides of a box meet at right angles.
TEST(FoundCreases, OfABoxKeepTheirRightAngles) {
  Mesh box = cube();
  for (int level = 0; level < 2; ++level) {
    const Topology topology(box);
    const Values points = refine_midpoints(topology, SchemeKind::CatmullClark, box.points);
    box = mesh_from_topology(Refinement(topology, kCatmullClark).child());
    box.points = points;
  }
  const FoundCreases creases = interpolate_with_found(box);
  EXPECT_EQ(creases.count, 12U * 4U);
  EXPECT_LE(creases.max_error, 1e-10);
  // At the 8 corners, normals are those of the first and last edge of each side.
  for (const CreaseEnd& end : creases.ends) EXPECT_NEAR(end.reached, 90.0, 1e-6);
}

TEST(FoundCreases, OfABracketStaySharp) {
  Mesh bracket = read_mesh(test::source_folder() + "/models/bracket.obj");
  bracket.creases.clear();
  const FoundCreases creases = interpolate_with_found(bracket);
  EXPECT_EQ(creases.count, 165U);
  EXPECT_LE(creases.max_error, 1e-10);
  // Least where creases run out into smooth faces, at both ends of the rib.
  EXPECT_LE(mean_change(creases), 4.0);
  EXPECT_GE(share_kept(creases), 0.97);
}

TEST(FoundCreases, OfFandiskStaySharp) {
  const char* const data = std::getenv("BATTEN_DATA");
  if (data == nullptr) GTEST_SKIP() << "BATTEN_DATA is not set";
  const FoundCreases creases = interpolate_with_found(read_mesh(std::string(data) + "/meshes/fandisk.obj"));
  EXPECT_EQ(creases.count, 703U);
  EXPECT_LE(creases.max_error, 1e-10);
  EXPECT_LE(mean_change(creases), 0.4);
  EXPECT_GE(share_kept(creases), 0.998);
}

}  // namespace
}  // namespace batten
