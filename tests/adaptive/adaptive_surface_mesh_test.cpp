#include "batten/adaptive/adaptive_surface_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/parallel.h"
#include "batten/patch/surface_patches.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/face_varying_limit.h"
#include "batten/tessellate/tessellator.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Colours at the vertices; at the corners texture coordinates with seams and a face without any; groups of two kinds.
Mesh with_values(Mesh mesh) {
  const Index faces = mesh.face_count();
  Buffer<Index> rows(mesh.face_vertices.size());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    rows[c] = c % 5 == 0 ? static_cast<Index>(c) + mesh.vertex_count() : mesh.face_vertices[c];
  }
  const Values uv = Values::Random(static_cast<Eigen::Index>(rows.size()) + mesh.vertex_count(), 2);
  if (faces > 2) std::fill(rows.begin() + mesh.face_offsets[1], rows.begin() + mesh.face_offsets[2], -1);
  mesh.attributes = {
      {"place", mesh.points, {}}, {"color", Values::Random(mesh.vertex_count(), 4), {}}, {"uv", uv, rows}};
  mesh.groups = {{"g", "first", 0}, {"usemtl", "red", faces / 3}, {"g", "last", faces - 1}};
  mesh.material_libraries = {"paint.mtl"};
  return mesh;
}

struct CarriedCase {
  std::string name;
  Mesh mesh;
  Scheme scheme;
  AdaptiveOptions options;
};

/// Quads, polygons and triangles under all schemes, in triangles and in quads, with a hole.
std::vector<CarriedCase> carried_cases() {
  std::vector<CarriedCase> all;
  const auto add = [&](const std::string& name, const Mesh& mesh, SchemeKind kind, FaceKind faces) {
    AdaptiveOptions options;
    options.faces = faces;
    options.angle = 35.0;
    options.edge_length = 0.3 * bounding_diagonal(mesh.points);
    options.max_level = 3;
    all.push_back({name, with_values(mesh), {kind}, options});
  };
  Mesh holed = test::jittered(grid(5, 4), 0.2, 2);
  holed.holes = {7};
  for (const FaceKind faces : {FaceKind::Quads, FaceKind::Triangles}) {
    add("grid with a hole", holed, SchemeKind::CatmullClark, faces);
    add("torus", test::jittered(torus(7, 5), 0.1, 3), SchemeKind::CatmullClark, faces);
    add("triangles as polygons", octahedron(), SchemeKind::CatmullClark, faces);
    add("octahedron", test::jittered(octahedron(), 0.1, 3), SchemeKind::Loop, faces);
  }
  const Mesh triangles = triangulated(test::jittered(torus(7, 5), 0.1, 3));
  add("triangles", triangles, SchemeKind::ModifiedButterfly, FaceKind::Triangles);
  return all;
}

AdaptiveMesh carried(const CarriedCase& which) {
  return adaptive_surface_mesh(Topology(which.mesh), which.scheme, which.mesh, which.options);
}

template <typename Visit>
void for_each_carried(const Visit& visit) {
  for (const CarriedCase& which : carried_cases()) {
    SCOPED_TRACE(which.name);
    visit(which, carried(which));
  }
}

const Attribute& named(const Mesh& mesh, const std::string& name) {
  const auto found =
      std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [&](const Attribute& a) { return a.name == name; });
  if (found == mesh.attributes.end()) throw Error(ErrorCode::BadArgument, "no attribute " + name);
  return *found;
}

/// The attributes at the vertices include the points themselves.
TEST(AdaptiveSurfaceMesh, AtVerticesFollowTheSurfaceAsThePointsDo) {
  for_each_carried([](const CarriedCase& which, const AdaptiveMesh& result) {
    // To rounding: compilers may contract the sums of one and the other differently.
    EXPECT_LT((named(result.mesh, "place").values - result.mesh.points).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(named(result.mesh, "color").values.cols(), 4);
    Mesh first_colors = which.mesh;
    first_colors.points = named(which.mesh, "color").values.rightCols(3);
    const Topology topology(which.mesh);
    const Values& colors = named(result.mesh, "color").values;
    const Tessellator tessellator(topology, which.scheme, 6);
    Buffer<double> uniform(3 * static_cast<std::size_t>(tessellator.vertex_count()));
    tessellator.limit<double>(first_colors.points, uniform);
    for (std::size_t v = 0; v < result.places.size(); ++v) {
      const SurfacePlace& place = result.places[v];
      const double i = place.u * tessellator.steps();
      const double j = place.v * tessellator.steps();
      if (i != std::floor(i) || j != std::floor(j)) continue;  // the middle of a triangle
      const Index at = tessellator.vertex(place.face, static_cast<Index>(i), static_cast<Index>(j));
      for (Eigen::Index k = 0; k < 3; ++k) {
        ASSERT_NEAR(colors(static_cast<Eigen::Index>(v), k + 1), uniform[3 * static_cast<std::size_t>(at) + k], 1e-12);
      }
    }
  });
}

/// Rows of a uniform tessellation, whose corner values are tested against step by step refinement.
class UniformCorners {
 public:
  explicit UniformCorners(const CarriedCase& which)
      : tessellator_(Topology(with_no_holes(which.mesh)), which.scheme, 6),
        attribute_(tessellator_.at_corners(named(which.mesh, "uv"))) {
    Buffer<Index> faces(attribute_.corner_rows.size());
    tessellator_.faces(faces);
    const std::size_t per_face = faces.size() / static_cast<std::size_t>(tessellator_.base().face_count());
    for (std::size_t c = 0; c < faces.size(); ++c) {
      rows_[{static_cast<Index>(c / per_face), faces[c]}] = attribute_.corner_rows[c];
    }
  }
  /// False for a place that uniform refinement does not reach.
  bool find(Index face, const std::array<double, 2>& at, Index& row) const {
    const double i = at[0] * tessellator_.steps();
    const double j = at[1] * tessellator_.steps();
    if (i != std::floor(i) || j != std::floor(j)) return false;
    row = rows_.at({face, tessellator_.vertex(face, static_cast<Index>(i), static_cast<Index>(j))});
    return true;
  }
  const Values& values() const { return attribute_.values; }

 private:
  static Mesh with_no_holes(Mesh mesh) {
    mesh.holes.clear();
    return mesh;
  }
  Tessellator tessellator_;
  Attribute attribute_;
  std::map<std::pair<Index, Index>, Index> rows_;
};

TEST(AdaptiveSurfaceMesh, AtCornersAreLinearInTheirFacesAndKeepSeams) {
  for_each_carried([](const CarriedCase& which, const AdaptiveMesh& result) {
    const UniformCorners uniform(which);
    const Attribute& uv = named(result.mesh, "uv");
    ASSERT_EQ(uv.corner_rows.size(), result.mesh.face_vertices.size());
    std::map<Index, Index> uniform_row;
    std::set<Index> uniform_rows;
    Index missing = 0;
    for (std::size_t c = 0; c < uv.corner_rows.size(); ++c) {
      const Index face = result.base_faces[c / static_cast<std::size_t>(result.mesh.face_size(0))];
      Index expected = -1;
      if (!uniform.find(face, result.corner_parameters[c], expected)) continue;
      const Index row = uv.corner_rows[c];
      ASSERT_EQ(row < 0, expected < 0);
      missing += row < 0 ? 1 : 0;
      if (row < 0) continue;
      ASSERT_LT((uv.values.row(row) - uniform.values().row(expected)).norm(), 1e-14);
      // Corners share a row exactly where uniform refinement lets them.
      ASSERT_EQ(uniform_row.emplace(row, expected).first->second, expected);
      uniform_rows.insert(expected);
    }
    EXPECT_EQ(uniform_row.size(), uniform_rows.size());
    EXPECT_GT(missing, 0);
  });
}

/// Where the same places of a uniform tessellation have their values, and where linear values stand.
TEST(AdaptiveSurfaceMesh, AtCornersFollowTheFaceVaryingRule) {
  for (const CarriedCase& which : carried_cases()) {
    SCOPED_TRACE(which.name);
    if (is_interpolating(which.scheme.kind)) continue;
    Scheme scheme = which.scheme;
    scheme.face_varying = FaceVaryingRule::CornersOnly;
    const Topology topology(which.mesh);
    const AdaptiveMesh smooth = adaptive_surface_mesh(topology, scheme, which.mesh, which.options);
    const Tessellator tessellator(topology, scheme, 6);
    const Attribute uniform =
        face_varying_limit(with_surface_holes(topology, scheme), scheme, named(which.mesh, "uv"), 6);
    Buffer<Index> faces(uniform.corner_rows.size());
    tessellator.faces(faces);
    // By base face and vertex; holes have no faces there.
    std::map<std::pair<Index, Index>, Index> rows;
    const auto steps = static_cast<std::size_t>(tessellator.steps());
    const std::size_t per_face = steps * steps * static_cast<std::size_t>(tessellator.face_size());
    const SurfacePatches patches(topology, scheme);
    std::size_t first = 0;
    for (Index f = 0; f < tessellator.base().face_count(); ++f) {
      if (!patches.holes().empty() && patches.holes()[f] != 0) continue;
      for (std::size_t c = first; c < first + per_face; ++c) rows[{f, faces[c]}] = uniform.corner_rows[c];
      first += per_face;
    }
    const Attribute& uv = named(smooth.mesh, "uv");
    Index compared = 0;
    for (std::size_t c = 0; c < uv.corner_rows.size(); ++c) {
      const Index face = smooth.base_faces[c / static_cast<std::size_t>(smooth.mesh.face_size(0))];
      const double i = smooth.corner_parameters[c][0] * tessellator.steps();
      const double j = smooth.corner_parameters[c][1] * tessellator.steps();
      if (i != std::floor(i) || j != std::floor(j)) continue;
      const Index expected = rows.at({face, tessellator.vertex(face, static_cast<Index>(i), static_cast<Index>(j))});
      ASSERT_EQ(uv.corner_rows[c] < 0, expected < 0);
      if (expected < 0) continue;
      ASSERT_LT((uv.values.row(uv.corner_rows[c]) - uniform.values.row(expected)).norm(), 1e-12);
      ++compared;
    }
    EXPECT_GT(compared, 0);
  }
}

TEST(AdaptiveSurfaceMesh, MidpointsAreThoseOfUniformRefinement) {
  for (const CarriedCase& which : carried_cases()) {
    SCOPED_TRACE(which.name);
    Mesh mesh = which.mesh;
    for (Attribute& attribute : mesh.attributes) attribute.carry = CarryRule::Midpoint;
    const Topology topology(mesh);
    const AdaptiveMesh result = adaptive_surface_mesh(topology, which.scheme, mesh, which.options);
    const Tessellator tessellator(topology, which.scheme, 6);
    const Values uniform = tessellator.midpoints(named(mesh, "color").values);
    const Values& colors = named(result.mesh, "color").values;
    for (std::size_t v = 0; v < result.places.size(); ++v) {
      const SurfacePlace& place = result.places[v];
      const double i = place.u * tessellator.steps();
      const double j = place.v * tessellator.steps();
      if (i != std::floor(i) || j != std::floor(j)) continue;
      const Index at = tessellator.vertex(place.face, static_cast<Index>(i), static_cast<Index>(j));
      ASSERT_LT((colors.row(static_cast<Eigen::Index>(v)) - uniform.row(at)).norm(), 1e-14);
    }
  }
}

std::string group_at(const std::vector<Group>& groups, const std::string& keyword, Index face) {
  std::string name;
  for (const Group& group : groups) {
    if (group.keyword == keyword && group.first_face <= face) name = group.name;
  }
  return name;
}

TEST(AdaptiveSurfaceMesh, FacesKeepTheGroupsOfTheirControlFaces) {
  for_each_carried([](const CarriedCase& which, const AdaptiveMesh& result) {
    const Topology topology(which.mesh);
    const SurfacePatches patches(topology, which.scheme);
    EXPECT_EQ(result.mesh.material_libraries, which.mesh.material_libraries);
    for (Index f = 0; f < result.mesh.face_count(); ++f) {
      const Index control = patches.control_face(result.base_faces[f]);
      for (const char* keyword : {"g", "usemtl"}) {
        ASSERT_EQ(group_at(result.mesh.groups, keyword, f), group_at(which.mesh.groups, keyword, control));
      }
    }
  });
}

/// Each face as its corners' points and normals.
std::multiset<std::vector<double>> faces_of(const AdaptiveMesh& result) {
  std::multiset<std::vector<double>> faces;
  const auto size = static_cast<std::size_t>(result.mesh.face_size(0));
  const Attribute* at_corners = nullptr;
  for (const Attribute& attribute : result.mesh.attributes) {
    if (attribute.name == "normal" && attribute.per_corner()) at_corners = &attribute;
  }
  for (std::size_t f = 0; f < result.base_faces.size(); ++f) {
    std::vector<double> face{static_cast<double>(result.base_faces[f])};
    for (std::size_t c = f * size; c < (f + 1) * size; ++c) {
      for (int k = 0; k < 3; ++k) face.push_back(result.mesh.points(result.mesh.face_vertices[c], k));
      for (int k = 0; k < 3 && at_corners != nullptr; ++k) {
        face.push_back(at_corners->values(at_corners->corner_rows[c], k));
      }
      face.insert(face.end(), result.corner_parameters[c].begin(), result.corner_parameters[c].end());
    }
    faces.insert(face);
  }
  return faces;
}

TEST(AdaptiveSurfaceMesh, LeaveTheFacesThemselvesAsTheyAre) {
  CarriedCase which = carried_cases().front();
  which.mesh.creases = {{8, 9, kInfiniteSharpness}, {9, 10, kInfiniteSharpness}};
  which.options.angle = 5.0;
  const AdaptiveMesh plain =
      tessellate_adaptively(Topology(which.mesh), which.scheme, which.mesh.points, which.options);
  const AdaptiveMesh with = carried(which);
  EXPECT_EQ(plain.mesh.points, with.mesh.points);
  EXPECT_NE(plain.mesh.face_vertices, with.mesh.face_vertices);  // sorted for the groups
  EXPECT_EQ(faces_of(plain), faces_of(with));
}

TEST(AdaptiveSurfaceMesh, AreTheSameForAnyNumberOfThreads) {
  for (const CarriedCase& which : carried_cases()) {
    std::vector<AdaptiveMesh> results;
    for (const int threads : {1, 2}) {
      const ThreadLimit limit(threads);
      results.push_back(carried(which));
    }
    for (std::size_t i = 0; i < results[0].mesh.attributes.size(); ++i) {
      EXPECT_EQ(results[0].mesh.attributes[i].values, results[1].mesh.attributes[i].values);
      EXPECT_EQ(results[0].mesh.attributes[i].corner_rows, results[1].mesh.attributes[i].corner_rows);
    }
  }
}

TEST(AdaptiveSurfaceMesh, RefuseAttributesAndGroupsThatDoNotFit) {
  const CarriedCase good = carried_cases().front();
  const auto refused = [&](const std::function<void(Mesh&)>& spoil) {
    CarriedCase which = good;
    spoil(which.mesh);
    return test::code_of([&] { carried(which); });
  };
  EXPECT_EQ(refused([](Mesh& mesh) { mesh.attributes[2].corner_rows.pop_back(); }), ErrorCode::BadShape);
  EXPECT_EQ(refused([](Mesh& mesh) { mesh.attributes[1].values(3, 1) = std::nan(""); }), ErrorCode::NotFinite);
  EXPECT_EQ(refused([](Mesh& mesh) { mesh.attributes[1].values.conservativeResize(3, 4); }), ErrorCode::BadShape);
  EXPECT_EQ(refused([](Mesh& mesh) { mesh.groups.back().first_face = mesh.face_count() + 1; }),
            ErrorCode::IndexOutOfRange);
}

}  // namespace
}  // namespace batten
