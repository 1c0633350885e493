#include "batten/refine/spread_numbers.h"

#include <limits>

#include "batten/mesh/vertex_fields.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace batten {

Scalars spread_numbers(const Scalars& numbers, const Topology& topology, SchemeKind kind, Index count) {
  constexpr int kRounds = 3;
  Scalars all = Scalars::Constant(topology.vertex_count(), std::numeric_limits<double>::quiet_NaN());
  all.head(numbers.size()) = numbers;
  for (int round = 0; round < kRounds; ++round) fill_from_neighbours(topology, all);
  Topology finer = topology;
  while (finer.vertex_count() < count) {
    all = refine_midpoints(finer, kind, all);
    finer = Refinement(finer, Scheme{kind}).child();
  }
  return all;
}

}  // namespace batten
