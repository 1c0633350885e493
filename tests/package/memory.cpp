/// Matrices made on one side of the library's border and freed on the other: Eigen's own allocators differ with the
/// flags (docs/decisions/006-eigen-layout.md), so a wrong border crashes here.
#include <cstdio>
#include <string>
#include <utility>

#include "batten/batten.h"

/// What the library returns as a column or a row of numbers: made there, grown and freed here.
bool numbers_cross(const batten::Mesh& mesh) {
  const batten::Topology topology(mesh);
  const batten::Scheme scheme = batten::choose_scheme(mesh);
  const auto grow = [](auto numbers) {
    const double last = numbers[numbers.size() - 1];
    const auto count = numbers.size();
    numbers.conservativeResize(100 * count);
    return numbers[count - 1] == last;
  };
  batten::Curvature exact = batten::limit_curvature({topology, scheme, mesh.points}, topology);
  batten::DiscreteCurvature discrete = batten::discrete_curvature(topology, mesh.points);
  const batten::MeshSeries series(topology, scheme);
  return grow(std::move(exact.mean)) && grow(std::move(exact.gaussian)) && grow(std::move(discrete.mean)) &&
         grow(std::move(discrete.area)) && grow(series.weighted_centroid(mesh.points));
}

int main(int /*argc*/, char** argv) {
  const std::string file = std::string(argv[0]) + ".ply";
  for (int round = 0; round < 20; ++round) {
    batten::Mesh mesh = batten::triangulated(batten::torus(6 + round, 7));  // made there
    mesh.points.conservativeResize(mesh.vertex_count(), 3);                 // grown here
    const batten::Topology topology(mesh);
    const batten::Values targets = batten::Values::Random(mesh.vertex_count(), 3);
    for (const auto method : {batten::SolveMethod::Auto, batten::SolveMethod::Direct}) {
      const batten::Interpolator interpolator(topology, batten::choose_scheme(mesh), {.method = method});
      batten::Interpolant result = interpolator.solve(targets);
      if (result.report.max_error > 1e-8) return std::printf("max error %g\n", result.report.max_error), 1;
      result.control = targets;  // freed or kept here
      mesh.attributes.assign(1, batten::Attribute{"normal", std::move(result.control), {}});
      Eigen::SparseMatrix<double, Eigen::RowMajor> matrix = interpolator.limit_matrix().matrix();
      matrix = (2.0 * matrix).eval();
    }
    if (!numbers_cross(batten::torus(6 + round, 7))) return std::puts("grown numbers have changed"), 1;
    batten::write_mesh(file, mesh);
    mesh = batten::read_mesh(file);
    if (mesh.attributes.at(0).values != targets) return std::puts("the numbers have changed"), 1;
  }
  // The same Eigen types as inside the library, so that the linker may mix both sides' instantiations.
  Eigen::VectorXi integers = Eigen::VectorXi::LinSpaced(100, 0, 99);
  Eigen::VectorXd numbers = integers.cast<double>();
  numbers = (numbers * 2.0).eval();
  return numbers.sum() == 9900.0 ? 0 : 1;
}
