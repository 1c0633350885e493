/// Elastic surfaces: steps in time, and the way to rest beside the paper's.
#include <Eigen/IterativeLinearSolvers>
#include <cmath>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "batten/dynamics/contact.h"
#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/gravity.h"
#include "batten/dynamics/spring.h"
#include "batten/dynamics/time_forms.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

double processor_seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

std::shared_ptr<const Force> springs_of(const ElasticSurface& surface, Index count, double stiffness) {
  std::vector<PointSprings::Spring> springs;
  const Index faces = surface.patches().base().face_count();
  for (Index i = 0; i < count; ++i) {
    const double angle = 2.4 * i;
    const Eigen::Vector3d target(2.0 * std::cos(angle), 2.0 * std::sin(angle), std::cos(1.7 * i));
    const auto face = static_cast<Index>(std::int64_t{i} * faces / count);
    springs.push_back({{face, 0.3, 0.6}, stay_at(target), stiffness});
  }
  return std::make_shared<PointSprings>(surface, springs);
}

struct Job {
  std::string name;
  Index around;
  Index across;
  Index springs;  ///< 0: it falls on a plane instead
  int steps;
};

void add_steps(const Job& job, MarkdownTable& table) {
  const Mesh mesh = torus(job.around, job.across);
  std::unique_ptr<ElasticSurface> surface;
  const double build =
      seconds_of([&] { surface = std::make_unique<ElasticSurface>(Topology(mesh), choose_scheme(mesh), mesh.points); });
  std::vector<std::shared_ptr<const Force>> forces;
  if (job.springs > 0) {
    forces.push_back(springs_of(*surface, job.springs, 5.0));
  } else {
    forces.push_back(std::make_shared<Gravity>(*surface, Eigen::Vector3d(0.0, 0.0, -9.81)));
    forces.push_back(std::make_shared<Contact>(*surface, plane_obstacle({0.0, 0.0, -0.42}, {0.0, 0.0, 1.0})));
  }
  ElasticMotion motion(*surface, forces);
  ElasticState state = state_at_rest(*surface);
  const double first = seconds_of([&] { motion.step(state); });
  double processor = 0.0;
  int iterations = 0;
  const double all = seconds_of([&] {
    processor = processor_seconds([&] {
      for (int i = 0; i < job.steps; ++i) iterations += motion.step(state).solver_iterations;
    });
  });
  table.add({job.name, number(mesh.vertex_count(), 7), number(1e3 * build), number(1e3 * first),
             number(1e3 * all / job.steps), number(1e3 * processor / job.steps), number(1.0 * iterations / job.steps)});
}

/// The paper's way to an equilibrium: its formula (31), element sums to level 4, conjugate gradients without a
/// preconditioner. Returns the steps until no control point is farther than `tolerance` from `goal`.
int paper_steps(const ElasticSurface& surface, const PlaceSprings& springs, const Points& goal, double step,
                double tolerance) {
  const StepWeights weights = step_weights(TimeScheme::Paper, step);
  const ElasticSurface::Matrix pull =
      springs.rows->transposed * ElasticSurface::Matrix(springs.stiffness.asDiagonal() * springs.rows->rows);
  const ElasticSurface::Matrix matrix =
      weights.mass * surface.mass() + weights.damping * surface.damping() + surface.stiffness() + pull;
  const Points force = springs.rows->transposed * (springs.stiffness.asDiagonal() * springs.targets);
  Eigen::ConjugateGradient<ElasticSurface::Matrix, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner> solver(
      matrix);
  solver.setTolerance(1e-10);
  ElasticState state = state_at_rest(surface);
  int steps = 0;
  while ((state.positions - goal).rowwise().norm().maxCoeff() > tolerance && steps < 100000) {
    const Points right = inertia_force(TimeScheme::Paper, step, surface, state) + force;
    const Points next = solver.solveWithGuess(right, state.positions);
    state.velocities = (next - state.positions) / step;
    state.positions = next;
    ++steps;
  }
  return steps;
}

void add_paper(int levels, MarkdownTable& table) {
  const Mesh box = cube();
  const RefinedSurface fine = refine(Topology(box), choose_scheme(box), box.points, levels);
  ElasticOptions options;
  options.rest = RestModel::Point;
  options.measure = ElasticMeasure::Parameters;
  options.cutoff_levels = 4;
  options.material.damping = {4.0};
  const ElasticSurface surface(fine.topology, choose_scheme(box), fine.values, options);
  const auto force = springs_of(surface, 4, 200.0);
  ForceSum sum;
  const Points still = Points::Zero(surface.rest().rows(), 3);
  sum.force = still;
  force->add({0.0, 0.0, surface.rest(), surface.rest(), still}, sum);
  ElasticState goal = state_at_rest(surface);
  const auto ours = [&] {
    goal = state_at_rest(surface);
    ElasticMotion(surface, {force}).find_equilibrium(goal);
  };
  ours();
  constexpr double kStep = 1.0 / 30.0;
  const double tolerance = 1e-4 * surface.diagonal();
  int steps = 0;
  const auto paper = [&] { steps = paper_steps(surface, sum.springs.front(), goal.positions, kStep, tolerance); };
  const std::vector<double> seconds = in_turn({ours, paper}, 3);
  table.add({number(surface.rest().rows(), 7), number(1e3 * seconds[0]), number(1e3 * seconds[1]), number(steps, 6),
             number(seconds[1] / seconds[0])});
}

}  // namespace

std::string dynamics_section() {
  MarkdownTable steps(
      {"body", "control points", "build, ms", "first step, ms", "step, ms", "processor, ms", "iterations a step"});
  for (const Job& job : {Job{"torus, 10 springs", 40, 25, 10, 60}, Job{"torus, 100 springs", 125, 80, 100, 30},
                         Job{"torus on a plane", 125, 80, 0, 15}, Job{"torus on a plane", 400, 250, 0, 4}}) {
    add_steps(job, steps);
  }
  MarkdownTable paper({"control points", "equilibrium, ms", "the paper's steps, ms", "their number", "ratio"});
  for (const int levels : {2, 3}) add_paper(levels, paper);
  return "## Elastic surfaces\n\nSteps of 1/60 s by backward Euler, two rounds each, in the rest shape's lengths, "
         "faces "
         "turning. The first step factors the system.\n\n" +
         steps.text() +
         "\nA cube refined 2 and 3 times, four springs, the paper's energy: from rest to within 1e-4 of the "
         "diagonal "
         "of the equilibrium, by `find_equilibrium` and by the paper's formula (31) with steps of 1/30 s, element sums "
         "to level 4 and conjugate gradients without a preconditioner.\n\n" +
         paper.text() + "\n";
}

}  // namespace batten::bench
