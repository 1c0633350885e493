// page_work MESH LEVELS: what the page's engine does at each move, natively in one thread: tessellates the surface of a
// control mesh to so many levels, and makes a step of an elastic surface that a spring pulls (studio/engine). Prints
// the medians in milliseconds as JSON; studio/tests/native.mjs sets them beside the page's.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "batten/batten.h"

namespace {

using namespace batten;

volatile float benchmark_sink = 0;  // without it the copies would not be made

template <typename Work>
double median_ms(const Work& work) {
  constexpr int kRuns = 25;
  std::vector<double> times;
  for (int run = 0; run < kRuns; ++run) {
    const Stopwatch watch;
    work();
    times.push_back(1e3 * watch.seconds());
  }
  std::nth_element(times.begin(), times.begin() + kRuns / 2, times.end());
  return times[kRuns / 2];
}

double tessellation(const Mesh& mesh, const Scheme& scheme, int levels) {
  const Tessellator tessellator(Topology(mesh), scheme, levels);
  std::vector<float> points(3 * static_cast<std::size_t>(tessellator.vertex_count()));
  std::vector<float> normals(points.size());
  // The page's arrays, which are filled again and again.
  std::vector<float> own_points(points.size());
  std::vector<float> own_normals(points.size());
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> control(mesh.points.rows(), 3);
  return median_ms([&] {
    tessellator.limit<float>(mesh.points, points, normals);
    std::copy(points.begin(), points.end(), own_points.begin());
    std::copy(normals.begin(), normals.end(), own_normals.begin());
    control = mesh.points.cast<float>();
    benchmark_sink = own_points.back() + own_normals.back() + control(0, 0);
  });
}

/// As Elastic in studio/engine/elastic.cpp makes it of a closed mesh, with a hand at its first face.
double elastic_step(const Mesh& mesh, const Scheme& scheme) {
  const Points rest = (mesh.points.rowwise() - mesh.points.colwise().mean()) / bounding_diagonal(mesh.points);
  const ElasticSurface body(Topology(mesh), scheme, rest, {.material = {{1.0}, {4.0}, {40.0}, {0.1}}});
  const LimitSurface surface(body.patches(), rest);
  std::vector<PointSprings::Spring> holds;
  const Index stride = std::max<Index>(1, surface.base().face_count() / 64);
  for (Index face = 0; face < surface.base().face_count(); face += stride) {
    const SurfacePlace place{face, 0.5, 0.5};
    holds.push_back({place, stay_at(surface.jet(place).point), 1500.0 / 64});
  }
  const SurfacePlace held{0, 0.5, 0.5};
  const Eigen::Vector3d hand = surface.jet(held).point + Eigen::Vector3d(0.0, 0.0, 0.2);
  ElasticMotion motion(
      body, {std::make_shared<PointSprings>(body, std::move(holds)),
             std::make_shared<PointSprings>(body, std::vector<PointSprings::Spring>{{held, stay_at(hand), 400.0}})});
  ElasticState state = state_at_rest(body);
  return median_ms([&] { motion.step(state); });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const ThreadLimit one(1);
  const Mesh mesh = read_mesh(argv[1]);
  const Scheme scheme = choose_scheme(mesh);
  std::printf("{\"tessellate\": %.4f, \"step\": %.4f}\n", tessellation(mesh, scheme, std::atoi(argv[2])),
              elastic_step(mesh, scheme));
}
