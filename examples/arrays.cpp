#include <cstdio>
#include <vector>

#include "batten/batten.h"

/// A mesh from a program's own arrays: an open box, whose rim is a boundary and whose bottom edges are creased.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::vector<double> xyz{0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1, 2, 1, 1, 0, 1, 1};
  const std::vector<int> quads{3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
  batten::Mesh box;
  box.points = Eigen::Map<const batten::Points>(xyz.data(), 8, 3);
  for (std::size_t i = 0; i < quads.size(); i += 4) {
    box.add_face({quads[i], quads[i + 1], quads[i + 2], quads[i + 3]});
  }
  for (int i = 0; i < 4; ++i) box.creases.push_back({i, (i + 1) % 4, batten::kInfiniteSharpness});
  for (const batten::MeshProblem& problem : batten::check(box)) {
    std::puts(problem.messages.front().c_str());
  }
  batten::write_mesh(argv[1], batten::interpolate(box).mesh);
}
