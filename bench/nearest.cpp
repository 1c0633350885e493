#include <cstdlib>
#include <ctime>
#include <random>

#include "batten/io/io.h"
#include "batten/nearest/nearest_point.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

constexpr Index kQueries = 200'000;
constexpr double kNear = 0.05;  ///< of the diagonal
constexpr int kRounds = 5;

struct Surface {
  std::string name;
  Mesh mesh;
  Scheme scheme;
};

Surface surface_of(const std::string& name, const std::string& path, SchemeKind kind) {
  Surface surface{name, read_mesh(path), {}};
  surface.scheme = choose_scheme(surface.mesh);
  surface.scheme.kind = kind;
  return surface;
}

std::vector<Surface> surfaces() {
  const std::string models = std::string(BATTEN_SOURCE_DIR) + "/models/";
  std::vector<Surface> all{surface_of("creature", models + "creature.obj", SchemeKind::CatmullClark)};
  const char* data = std::getenv("BATTEN_DATA");
  if (data == nullptr) return all;
  const std::string meshes = std::string(data) + "/meshes/";
  all.push_back(surface_of("beast", meshes + "beast.obj", SchemeKind::CatmullClark));
  all.push_back(surface_of("spot, quads", meshes + "spot-quads.obj", SchemeKind::CatmullClark));
  all.push_back(surface_of("spot, triangles", meshes + "spot.obj", SchemeKind::Loop));
  return all;
}

/// Queries up to kNear of the diagonal from places anywhere on the surface.
Points random_queries(const LimitSurface& surface, bool quads, double diagonal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  Points queries(kQueries, 3);
  for (Index i = 0; i < kQueries; ++i) {
    const auto face = static_cast<Index>(random() % static_cast<unsigned>(surface.base().face_count()));
    double u = unit(random);
    double v = unit(random);
    if (!quads && u + v > 1.0) {
      u = 1.0 - u;
      v = std::min(1.0 - v, 1.0 - u);
    }
    const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
    const Eigen::Vector3d shift = kNear * diagonal * unit(random) * direction.normalized();
    queries.row(i) = (surface.jet({face, u, v}).point + shift).transpose();
  }
  return queries;
}

/// The time of all threads together: on a machine that others use too it means more than the time on the clock.
double processor_seconds(const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int round = -1; round < kRounds; ++round) {
    const std::clock_t start = std::clock();
    work();
    if (round >= 0) seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return median(seconds);
}

}  // namespace

std::string nearest_section() {
  MarkdownTable table({"surface", "faces", "build, us a face", "other control points, us a face", "a query, us",
                       "thousand queries a second on two cores"});
  for (const Surface& subject : surfaces()) {
    const Topology topology(subject.mesh);
    const LimitSurface surface(topology, subject.scheme, subject.mesh.points);
    const NearestPoints nearest(topology, subject.scheme, subject.mesh.points);
    const Points queries = random_queries(surface, subject.scheme.kind == SchemeKind::CatmullClark, nearest.diagonal());
    std::vector<NearestPoint> found(static_cast<std::size_t>(kQueries));
    const double build =
        processor_seconds([&] { const NearestPoints again(topology, subject.scheme, subject.mesh.points); });
    NearestPoints moving(topology, subject.scheme, subject.mesh.points);
    const Points moved = 1.01 * subject.mesh.points;
    const double set = processor_seconds([&] { moving.set_control(moved); });
    const double query = processor_seconds([&] { nearest.nearest(queries, found); }) / kQueries;
    table.add({subject.name, std::to_string(topology.face_count()), number(1e6 * build / topology.face_count()),
               number(1e6 * set / topology.face_count()), number(1e6 * query), number(2e-3 / query)});
  }
  return "## Nearest point\n\nOf points up to 5 % of the diagonal from the surface, in no order; proved to 1e-10 of "
         "the diagonal. "
         "Times are the\nprocessor's, of all threads together.\n\n" +
         table.text() + "\n";
}

}  // namespace batten::bench
