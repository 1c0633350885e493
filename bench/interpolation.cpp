#include <cmath>
#include <cstdlib>
#include <random>

#include "batten/interpolate/interpolation_updates.h"
#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

constexpr double kTolerance = 1e-10;

/// Moves the points by up to 0.3 mean edge lengths.
void shake(const Topology& topology, Values& points) {
  double length = 0.0;
  for (Index e = 0; e < topology.edge_count(); e += 17) {
    const Index h = topology.edge_half_edge(e);
    length += (points.row(topology.origin(h)) - points.row(topology.destination(h))).norm();
  }
  length /= (topology.edge_count() + 16) / 17;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-0.3 * length, 0.3 * length);
  for (double& coordinate : points.reshaped()) coordinate += uniform(generator);
}

Subject refined(const std::string& name, const Mesh& mesh, Index vertices) {
  const Scheme scheme = choose_scheme(mesh);
  RefinedSurface surface{Topology(mesh), mesh.points};
  int levels = 0;
  while (surface.topology.vertex_count() < vertices) {
    surface = refine(surface.topology, scheme, surface.values, 1);
    ++levels;
  }
  shake(surface.topology, surface.values);
  return {name + " refined " + std::to_string(levels) + " times", std::move(surface.topology), scheme,
          std::move(surface.values)};
}

InterpolateOptions options_of(SolveMethod method) {
  InterpolateOptions options;
  options.method = method;
  options.tolerance = kTolerance;
  return options;
}

/// Eigen's tolerance is relative and of another norm: the loosest power of ten that reaches ours.
double eigen_tolerance(const Subject& subject) {
  const double wanted = kTolerance * bounding_diagonal(subject.targets);
  double tolerance = 1e-9;
  while (tolerance > 1e-15 && eigen_conjugate_gradients(subject, tolerance) > wanted) tolerance *= 0.1;
  return tolerance;
}

std::string against_rivals(const Subject& subject, bool with_cholesky) {
  const double tolerance = kTolerance * bounding_diagonal(subject.targets);
  const Interpolator ours(subject.topology, subject.scheme, options_of(SolveMethod::Auto));
  const Interpolator thall(subject.topology, subject.scheme, options_of(SolveMethod::Jacobi));
  const Interpolator lai(subject.topology, subject.scheme, options_of(SolveMethod::Richardson));
  const Interpolator plain(subject.topology, subject.scheme, options_of(SolveMethod::ConjugateGradient));
  const Sweeps sweeps(subject);
  const double eigen = eigen_tolerance(subject);
  int iterations[6] = {};
  const auto solve = [&](const Interpolator& interpolator, int place) {
    return [&, place] {
      const SolveReport solved = interpolator.solve(subject.targets).report.solve;
      iterations[place] = solved.iterations;
      if (!solved.converged) throw std::runtime_error(solved.method_name + " did not converge");
    };
  };
  const std::vector<double> seconds =
      in_turn({solve(ours, 0), [&] { iterations[1] = sweeps.run(subject, SolveMethod::Jacobi, tolerance); },
               [&] { iterations[2] = sweeps.run(subject, SolveMethod::Richardson, tolerance); }, solve(thall, 3),
               solve(lai, 4), solve(plain, 5), [&] { eigen_conjugate_gradients(subject, eigen); },
               [&] { const Interpolator built(subject.topology, subject.scheme, options_of(SolveMethod::Auto)); }},
              5);
  const double vertices = subject.topology.vertex_count();
  MarkdownTable table({"", "iterations", "ms", "ns a vertex", "times ours"});
  const auto add = [&](const std::string& name, const std::string& count, double taken, double base) {
    table.add({name, count, number(1e3 * taken), number(1e9 * taken / vertices), number(taken / base, 3)});
  };
  add("**Batten, solve**", std::to_string(iterations[0]), seconds[0], seconds[0]);
  add("Thall's iteration, sweeps", std::to_string(iterations[1]), seconds[1], seconds[0]);
  add("Lai and Cheng's iteration, sweeps", std::to_string(iterations[2]), seconds[2], seconds[0]);
  add("Thall's iteration, in our tiles", std::to_string(iterations[3]), seconds[3], seconds[0]);
  add("Lai and Cheng's iteration, in our tiles", std::to_string(iterations[4]), seconds[4], seconds[0]);
  add("our conjugate gradients (double, matrix-free)", std::to_string(iterations[5]), seconds[5], seconds[0]);
  if (with_cholesky) {
    const Interpolator direct(subject.topology, subject.scheme, options_of(SolveMethod::Direct));
    add("sparse Cholesky (Eigen), assembly included", "", seconds_of([&] { direct.solve(subject.targets); }),
        seconds[0]);
  }
  add("Batten, build", "", seconds[7], seconds[0]);
  add("**Batten, build and solve**", std::to_string(iterations[0]), seconds[0] + seconds[7], seconds[0] + seconds[7]);
  add("Eigen's conjugate gradients, assembly included", "", seconds[6], seconds[0] + seconds[7]);
  return "### " + subject.name + ": " + std::to_string(subject.topology.vertex_count()) + " vertices\n\n" +
         table.text() + "\n";
}

}  // namespace

Subject subject(Index vertices) {
  const char* data = std::getenv("BATTEN_DATA");
  if (data != nullptr) return refined("beast", read_mesh(std::string(data) + "/meshes/beast.obj"), vertices);
  return refined("creature", read_mesh(BATTEN_SOURCE_DIR "/models/creature.obj"), vertices);
}

Subject torus_subject(Index vertices) {
  const auto across = static_cast<Index>(std::sqrt(vertices / 2.0));
  const Mesh mesh = torus(2 * across, across);
  Topology topology(mesh);
  Values targets = mesh.points;
  shake(topology, targets);
  return {"torus", std::move(topology), Scheme(), std::move(targets)};
}

std::string interpolation_section() {
  return "## Interpolation to 1e-10 of the diagonal, three columns\n\n" + against_rivals(subject(500000), true) +
         against_rivals(subject(2000000), false);
}

std::string growth_section() {
  MarkdownTable table({"vertices", "iterations", "solve, ms", "solve, ns a vertex", "build, ns a vertex"});
  for (const Index vertices : {10000, 40000, 160000, 640000, 2560000, 4000000}) {
    const Subject torus = torus_subject(vertices);
    const Interpolator interpolator(torus.topology, torus.scheme);
    int iterations = 0;
    const std::vector<double> seconds =
        in_turn({[&] { iterations = interpolator.solve(torus.targets).report.solve.iterations; },
                 [&] { const Interpolator built(torus.topology, torus.scheme); }},
                5);
    const double count = torus.topology.vertex_count();
    table.add({std::to_string(torus.topology.vertex_count()), std::to_string(iterations), number(1e3 * seconds[0]),
               number(1e9 * seconds[0] / count), number(1e9 * seconds[1] / count)});
  }
  return "## Growth with size (noisy tori)\n\n" + table.text() + "\n";
}

namespace {

/// Moves so many targets by up to `share` of the diagonal: vertices whose numbers follow each other, which lie near
/// each other on a refined mesh.
void add_updates(InterpolationUpdates& updates, Index targets, double share, double whole, MarkdownTable& table) {
  const double length = share * bounding_diagonal(updates.targets());
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> shift(-length, length);
  std::vector<double> seconds;
  std::vector<double> moved;
  for (int move = 0; move < 101; ++move) {
    std::vector<Index> rows(static_cast<std::size_t>(targets));
    rows[0] = static_cast<Index>(generator() % static_cast<unsigned>(updates.targets().rows() - targets));
    for (std::size_t i = 1; i < rows.size(); ++i) rows[i] = rows[i - 1] + 1;
    const Values before = updates.targets().middleRows(rows[0], targets);
    Values values = before;
    for (double& coordinate : values.reshaped()) coordinate += shift(generator);
    UpdateReport report;
    seconds.push_back(seconds_of([&] { report = updates.update(rows, values); }));
    moved.push_back(report.moved);
    updates.update(rows, before);
  }
  table.add({std::to_string(targets), number(share), std::to_string(static_cast<Index>(median(moved))),
             number(1e3 * median(seconds)), number(whole / median(seconds))});
}

}  // namespace

std::string update_section() {
  const Subject moving = subject(500000);
  const Interpolator interpolator(moving.topology, moving.scheme);
  const double whole = in_turn({[&] { interpolator.solve(moving.targets); }}, 5)[0];
  InterpolationUpdates updates(interpolator, moving.targets);
  MarkdownTable table({"targets that move", "by, of the diagonal", "control points moved", "ms", "times faster"});
  for (const double share : {1e-4, 1e-3, 1e-2, 1e-1}) add_updates(updates, 1, share, whole, table);
  for (const Index targets : {10, 100, 1000}) add_updates(updates, targets, 1e-3, whole, table);
  return "## Targets that move, " + moving.name + ": " + std::to_string(moving.topology.vertex_count()) +
         " vertices\n\nBeside solving all of it again (" + number(1e3 * whole) + " ms), to 1/16 of its tolerance.\n\n" +
         table.text() + "\n";
}

}  // namespace batten::bench
