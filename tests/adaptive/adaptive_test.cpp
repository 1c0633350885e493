#include "batten/adaptive/adaptive.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>

#include "batten/adaptive/cell_faces.h"
#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/triangulate.h"
#include "batten/nearest/nearest_point.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/tessellator.h"
#include "support/shapes.h"

namespace batten {
namespace {

struct Case {
  std::string name;
  Mesh mesh;
  Scheme scheme;
};

/// The samples, with creases that stay and that fade, holes and poles, under both schemes.
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const Mesh& mesh) {
    Scheme scheme;
    all.push_back({name, mesh, scheme});
    scheme.kind = SchemeKind::Loop;
    if (all_triangles(mesh)) all.push_back({name + ", Loop", mesh, scheme});
  };
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    add(sample.name, sample.mesh);
    add(sample.name + ", tagged", test::with_random_tags(sample.mesh, 4));
  }
  Mesh holed = test::jittered(grid(5, 4), 0.1, 2);
  holed.holes = {7, 8};
  add("holes", holed);
  Mesh none = test::jittered(grid(5, 4), 0.1, 2);
  all.push_back({"no boundary faces", none, Scheme{}});
  all.back().scheme.boundary = BoundaryRule::None;
  return all;
}

AdaptiveMesh tessellated(const Case& which, const AdaptiveOptions& options) {
  const Topology topology(which.mesh);
  return tessellate_adaptively(topology, which.scheme, which.mesh.points, options);
}

AdaptiveOptions chord_of(const Case& which, double fraction, FaceKind faces, int max_level = 16) {
  AdaptiveOptions options;
  options.chord = fraction * bounding_diagonal(which.mesh.points);
  options.faces = faces;
  options.max_level = max_level;
  return options;
}

template <typename Visit>
void for_each_case(double fraction, int max_level, const Visit& visit) {
  for (const Case& which : cases()) {
    for (const FaceKind faces : {FaceKind::Triangles, FaceKind::Quads}) {
      SCOPED_TRACE(which.name + (faces == FaceKind::Quads ? ", quads" : ", triangles"));
      const AdaptiveOptions options = chord_of(which, fraction, faces, max_level);
      visit(which, options, tessellated(which, options));
    }
  }
}

TEST(Adaptive, HasNoCracks) {
  for_each_case(0.003, 8, [](const Case& which, const AdaptiveOptions& options, const AdaptiveMesh& result) {
    const Mesh& mesh = result.mesh;
    EXPECT_GT(mesh.face_count(), 0);
    for (Index f = 0; f < mesh.face_count(); ++f) {
      ASSERT_EQ(mesh.face_size(f), options.faces == FaceKind::Quads ? 4 : 3);
    }
    const Topology topology(mesh);  // refuses edges of three faces, and neighbours of opposite orientation
    const Topology control(which.mesh);
    const Topology shown = with_surface_holes(control, which.scheme);
    // What is open lies where the surface ends: as many boundary curves, of the same components.
    const auto open_edges = [](const Topology& t) {
      Index open = 0;
      for (Index e = 0; e < t.edge_count(); ++e) open += t.is_boundary_edge(e) ? 1 : 0;
      return open;
    };
    const LimitSurface surface(control, which.scheme, which.mesh.points);
    const Topology& base = surface.base();
    const Buffer<std::uint8_t> holes = surface_holes(control, which.scheme);
    if (open_edges(control) == 0 && holes.empty()) {
      EXPECT_EQ(open_edges(topology), 0);
    }
    for (Index e = 0; e < topology.edge_count(); ++e) {
      if (!topology.is_boundary_edge(e) || shown.has_holes()) continue;
      const Index h = topology.edge_half_edge(e);
      const Index face = result.base_faces[topology.face(h)];
      const auto a = result.corner_parameters[h];
      const auto b = result.corner_parameters[topology.next(h)];
      bool on_boundary = false;
      const bool quad = base.face_size(face) == 4;
      const auto on = [&](const std::array<double, 2>& at, Index s) {
        if (s == 0) return at[1] == 0.0;
        if (s == 1) return quad ? at[0] == 1.0 : at[0] + at[1] == 1.0;
        return s == 2 && quad ? at[1] == 1.0 : at[0] == 0.0;
      };
      for (Index s = 0; s < base.face_size(face); ++s) {
        on_boundary |= on(a, s) && on(b, s) && base.twin(base.face_begin(face) + s) < 0;
      }
      ASSERT_TRUE(on_boundary) << "an open edge inside the surface";
    }
  });
}

TEST(Adaptive, ClosesAroundAPoleOfValence360) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const Case pole{"pole", test::jittered(test::bipyramid(360), 0.0005, 3), {kind}};
    const AdaptiveOptions options = chord_of(pole, 0.02, FaceKind::Triangles);
    const AdaptiveMesh result = tessellated(pole, options);
    const Topology topology(result.mesh);
    for (Index e = 0; e < topology.edge_count(); ++e) ASSERT_FALSE(topology.is_boundary_edge(e));
    const Topology control(pole.mesh);
    const LimitSurface surface(control, pole.scheme, pole.mesh.points);
    EXPECT_LE(measured_chord(surface, result), options.chord);
  }
}

/// Compared with the uniform tessellator, which computes limits independently: every vertex is one of its vertices.
TEST(Adaptive, HasItsVerticesOnTheSurface) {
  for_each_case(0.003, 4, [](const Case& which, const AdaptiveOptions& options, const AdaptiveMesh& result) {
    const Topology topology(which.mesh);
    const Tessellator first(topology, which.scheme, 1);
    const int levels = 5 + (first.base().face_count() == topology.face_count() ? 0 : 1);
    const Tessellator tessellator(topology, which.scheme, levels);
    Buffer<double> points(3 * static_cast<std::size_t>(tessellator.vertex_count()));
    tessellator.limit<double>(which.mesh.points, points);
    const double diagonal = bounding_diagonal(which.mesh.points);
    const bool loop_quads = which.scheme.kind == SchemeKind::Loop && options.faces == FaceKind::Quads;
    const Index n = tessellator.steps();
    for (std::size_t c = 0; c < result.mesh.face_vertices.size(); ++c) {
      const Index vertex = result.mesh.face_vertices[c];
      const auto [u, v] = result.corner_parameters[c];
      const auto i = static_cast<Index>(u * n);
      const auto j = static_cast<Index>(v * n);
      if (loop_quads && (i != u * n || j != v * n)) continue;  // a triangle's centre is no grid point
      ASSERT_TRUE(i == u * n && j == v * n);
      const Index f = result.base_faces[c / static_cast<std::size_t>(result.mesh.face_size(0))];
      const Index there = tessellator.vertex(f, i, j);
      const Eigen::RowVector3d point(points[3 * there], points[3 * there + 1], points[3 * there + 2]);
      ASSERT_LE((result.mesh.points.row(vertex) - point).norm(), 1e-13 * diagonal);
    }
  });
}

TEST(Adaptive, KeepsTheChordTolerance) {
  for (const double fraction : {0.02, 0.002}) {
    for_each_case(fraction, 16, [](const Case& which, const AdaptiveOptions& options, const AdaptiveMesh& result) {
      const Topology topology(which.mesh);
      const LimitSurface surface(topology, which.scheme, which.mesh.points);
      EXPECT_EQ(result.unmet, 0);
      EXPECT_LE(measured_chord(surface, result), options.chord);
    });
  }
}

/// The reverse: places on the faces, compared with the proved nearest points of the surface.
TEST(Adaptive, HasNoFaceFartherFromTheSurfaceThanTheTolerance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for_each_case(0.002, 16, [&](const Case& which, const AdaptiveOptions& options, const AdaptiveMesh& result) {
    const Topology topology(which.mesh);
    const NearestPoints surface(topology, which.scheme, which.mesh.points);
    const Mesh& mesh = result.mesh;
    constexpr Index kPlaces = 1000;
    Values places(kPlaces, 3);
    for (Index i = 0; i < kPlaces; ++i) {
      const Index f = static_cast<Index>(random() % static_cast<unsigned>(mesh.face_count()));
      const Index* face = &mesh.face_vertices[mesh.face_offsets[f]];
      double a = unit(random);
      double b = unit(random);
      if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
      places.row(i) =
          (1.0 - a - b) * mesh.points.row(face[0]) + a * mesh.points.row(face[1]) + b * mesh.points.row(face[2]);
    }
    std::vector<NearestPoint> found(kPlaces);
    surface.nearest(places, found);
    double worst = 0.0;
    for (const NearestPoint& point : found) worst = std::max(worst, point.distance);
    EXPECT_LE(worst, options.chord);
  });
}

TEST(Adaptive, IsTheSameForAnyNumberOfThreads) {
  for (const Case& which : cases()) {
    SCOPED_TRACE(which.name);
    AdaptiveOptions options = chord_of(which, 0.01, FaceKind::Quads);
    options.angle = 40.0;
    options.max_level = 6;
    std::vector<AdaptiveMesh> results;
    for (const int threads : {1, 2}) {
      const ThreadLimit limit(threads);
      results.push_back(tessellated(which, options));
    }
    EXPECT_EQ(results[0].mesh.face_vertices, results[1].mesh.face_vertices);
    EXPECT_EQ(results[0].mesh.points, results[1].mesh.points);
    EXPECT_EQ(results[0].mesh.attributes[0].values, results[1].mesh.attributes[0].values);
  }
}

TEST(Adaptive, LeavesPlanesAsTheyAre) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (const Index size : {1, 6}) {
    Mesh mesh = grid(size, size);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Index i = v % (size + 1);
      const Index j = v / (size + 1);
      if (i > 0 && i < size) mesh.points(v, 0) += shift(random) * 0.3;
      if (j > 0 && j < size) mesh.points(v, 1) += shift(random) * 0.3;
    }
    for (const Index v : {0, size, size * (size + 1), size * (size + 2)}) mesh.corners.push_back({v, 10.0});
    const Case plane{"plane", mesh, Scheme{}};
    EXPECT_EQ(tessellated(plane, chord_of(plane, 1e-6, FaceKind::Quads)).mesh.face_count(), size * size);
    EXPECT_EQ(tessellated(plane, chord_of(plane, 1e-6, FaceKind::Triangles)).mesh.face_count(), 2 * size * size);
    const Mesh cut = triangulated(mesh);
    const Case triangles{"triangles", cut, {SchemeKind::Loop}};
    EXPECT_EQ(tessellated(triangles, chord_of(triangles, 1e-6, FaceKind::Triangles)).mesh.face_count(),
              2 * size * size);
  }
}

TEST(Adaptive, CutsOnlyWhereTheSurfaceBends) {
  // A plane with one point pulled out: cells far from it stay whole.
  Mesh mesh = grid(20, 20);
  mesh.points(10 * 21 + 10, 2) += 0.1;
  const Case bump{"bump", mesh, {SchemeKind::CatmullClark, BoundaryRule::EdgeAndCorner}};
  const AdaptiveMesh result = tessellated(bump, chord_of(bump, 1e-5, FaceKind::Triangles));
  Index far = 0;
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    const Index base = result.base_faces[f];
    far += std::abs(base % 20 - 10) > 4 && std::abs(base / 20 - 10) > 4 ? 1 : 0;
  }
  EXPECT_GE(result.deepest_level, 3);
  EXPECT_EQ(far, 2 * (6 + 5) * (6 + 5));
}

TEST(Adaptive, HasNoLongerEdgeThanAsked) {
  for (const Case& which : cases()) {
    for (const FaceKind faces : {FaceKind::Triangles, FaceKind::Quads}) {
      SCOPED_TRACE(which.name);
      AdaptiveOptions options;
      options.edge_length = 0.04 * bounding_diagonal(which.mesh.points);
      options.faces = faces;
      const AdaptiveMesh result = tessellated(which, options);
      EXPECT_EQ(result.unmet, 0);
      double longest = 0.0;
      const Mesh& mesh = result.mesh;
      for (Index f = 0; f < mesh.face_count(); ++f) {
        for (Index k = 0; k < mesh.face_size(f); ++k) {
          const Index a = mesh.face_vertices[mesh.face_offsets[f] + k];
          const Index b = mesh.face_vertices[mesh.face_offsets[f] + (k + 1) % mesh.face_size(f)];
          longest = std::max(longest, (mesh.points.row(a) - mesh.points.row(b)).norm());
        }
      }
      EXPECT_LE(longest, options.edge_length);
      EXPECT_DOUBLE_EQ(longest, result.longest_edge);
      EXPECT_GT(longest, 0.25 * options.edge_length);
    }
  }
}

TEST(Adaptive, TurnsNoFurtherThanAsked) {
  const Case torus_case{"torus", torus(12, 8), Scheme{}};
  const Case hull{"hull", test::random_hull(60, 2), {SchemeKind::Loop}};
  for (const Case& which : {torus_case, hull}) {
    for (const FaceKind faces : {FaceKind::Triangles, FaceKind::Quads}) {
      AdaptiveOptions options;
      options.angle = 10.0;
      options.faces = faces;
      const AdaptiveMesh result = tessellated(which, options);
      EXPECT_EQ(result.unmet, 0);
      EXPECT_LE(result.widest_angle, 10.0);
      const Values& normals = result.mesh.attributes[0].values;
      double widest = 0.0;
      for (std::size_t c = 0; c < result.mesh.face_vertices.size(); c += result.mesh.face_size(0)) {
        const Index a = result.mesh.face_vertices[c];
        const Index b = result.mesh.face_vertices[c + 1];
        widest =
            std::max(widest, std::acos(std::min(1.0, normals.row(a).dot(normals.row(b)))) * 180.0 / std::numbers::pi);
      }
      EXPECT_LE(widest, 10.0 + 1e-6);
      EXPECT_GT(widest, 2.5);
    }
  }
}

TEST(Adaptive, HasTheNormalsOfBothSidesOfACrease) {
  Mesh mesh = cube();
  const Topology plain(mesh);
  for (Index e = 0; e < plain.edge_count(); ++e) {
    const Index h = plain.edge_half_edge(e);
    mesh.creases.push_back({plain.origin(h), plain.destination(h), 10.0});
  }
  const Case which{"cube", mesh, Scheme{}};
  AdaptiveOptions options;
  options.edge_length = 0.5;
  const AdaptiveMesh result = tessellated(which, options);
  ASSERT_EQ(result.mesh.attributes.size(), 2U);
  const Attribute& corners = result.mesh.attributes[1];
  for (std::size_t c = 0; c < corners.corner_rows.size(); ++c) {
    // A cube with sharp edges stays one: its sides' normals are the axes.
    const Eigen::RowVector3d normal = corners.values.row(corners.corner_rows[c]);
    const Mesh& out = result.mesh;
    const std::size_t f = c / 3;
    const Eigen::RowVector3d a = out.points.row(out.face_vertices[3 * f]);
    const Eigen::Vector3d ab = (out.points.row(out.face_vertices[3 * f + 1]) - a).transpose();
    const Eigen::Vector3d ac = (out.points.row(out.face_vertices[3 * f + 2]) - a).transpose();
    EXPECT_LE((normal.transpose() - ab.cross(ac).normalized()).norm(), 1e-9);
  }
}

TEST(Adaptive, StartsWithTheControlMeshsVertices) {
  for_each_case(0.01, 6, [](const Case& which, const AdaptiveOptions& /*options*/, const AdaptiveMesh& result) {
    const Topology topology(which.mesh);
    if (with_surface_holes(topology, which.scheme).has_holes() || which.name.find("isolated") != std::string::npos) {
      return;
    }
    const Values limits = LimitMatrix(topology, which.scheme).apply(which.mesh.points);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      ASSERT_LE((result.mesh.points.row(v) - limits.row(v)).norm(), 1e-12 * bounding_diagonal(which.mesh.points));
    }
  });
}

TEST(Adaptive, NamesTheBoundThatCannotBe) {
  const auto refused = [](double chord, double edge_length, double angle) -> std::string {
    AdaptiveOptions options;
    options.chord = chord;
    options.edge_length = edge_length;
    options.angle = angle;
    try {
      tessellated({"cube", cube(), Scheme{}}, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::BadArgument);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused(-1e-3, 0.0, 1.0).find("chord tolerance is -0.001;"), std::string::npos);
  EXPECT_NE(refused(0.1, std::nan(""), 0.0).find("edge length is nan;"), std::string::npos);
  EXPECT_NE(refused(0.1, 0.0, HUGE_VAL).find("angle is inf;"), std::string::npos);
}

TEST(Adaptive, RefusesBoundsThatCannotBe) {
  const Case which{"cube", cube(), Scheme{}};
  const auto code = [&](const AdaptiveOptions& options) {
    try {
      tessellated(which, options);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  EXPECT_EQ(code({}), ErrorCode::BadArgument);
  AdaptiveOptions options;
  options.chord = 1e-6;
  options.max_faces = 1000;
  EXPECT_EQ(code(options), ErrorCode::TooLarge);
  options.chord = 0.0;
  options.edge_length = 1e-3;
  EXPECT_EQ(code(options), ErrorCode::TooLarge);
  options.max_level = 17;
  EXPECT_EQ(code(options), ErrorCode::BadArgument);
  options.max_faces = 100'000;
  options.max_level = 2;
  EXPECT_GT(tessellated(which, options).unmet, 0);
}

TEST(Adaptive, CountsACellOnceWhateverItIsBeyond) {
  const Case which{"cube", cube(), Scheme{}};
  AdaptiveOptions options;
  options.chord = 1e-9;
  options.edge_length = 1e-9;
  options.max_level = 1;
  EXPECT_EQ(tessellated(which, options).unmet, 24);
}

TEST(Adaptive, CountsACellOnceThoughItWasMeasuredBeforeItWasQuartered) {
  const Case which{"cube", cube(), Scheme{}};
  AdaptiveOptions options;
  options.edge_length = 1e-9;
  options.faces = FaceKind::Quads;
  options.max_level = 0;
  EXPECT_EQ(tessellated(which, options).unmet, 6);
}

TEST(Adaptive, CountsACellOnceThoughFacesOfItBetweenOthersAreWithinTheBound) {
  const Case which{"cube", cube(), Scheme{}};
  AdaptiveOptions options;
  options.faces = FaceKind::Quads;
  options.max_level = 0;
  int asked = 0;
  options.cut = [&](const AdaptiveFace&) { return asked++ % 2 == 0; };
  EXPECT_EQ(tessellated(which, options).unmet, 6);
}

TEST(Adaptive, AMeshHasNoMoreCornersThanAnIndexCounts) {
  const Index all = std::numeric_limits<Index>::max();
  EXPECT_EQ(most_faces(all, 4), 536'870'911);
  EXPECT_EQ(most_faces(all, 3), 715'827'882);
  EXPECT_EQ(most_faces(1000, 4), 1000);
  const Case which{"cube", cube(), Scheme{}};
  AdaptiveOptions options = chord_of(which, 0.1, FaceKind::Quads);
  options.max_faces = all;
  EXPECT_GT(tessellated(which, options).mesh.face_count(), 0);
}

}  // namespace
}  // namespace batten
