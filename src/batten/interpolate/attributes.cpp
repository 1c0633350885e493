#include "batten/interpolate/attributes.h"

#include <utility>

#include "batten/progress.h"

namespace batten {

namespace {

bool is_value_at_vertices(const Attribute& attribute) { return !attribute.per_corner() && attribute.name != "normal"; }

}  // namespace

PreparedAttributes prepare_attributes(const Topology& topology, const Scheme& scheme, Mesh mesh,
                                      const AttributeOptions& options, const Progress& progress) {
  constexpr double kBuilt = 0.4;  // of the time
  PreparedAttributes prepared{std::move(mesh), {}};
  std::vector<Targets> sets;
  for (Attribute& attribute : prepared.mesh.attributes) {
    if (!is_value_at_vertices(attribute)) continue;
    attribute.carry = options.rule == AttributeRule::Midpoint ? CarryRule::Midpoint : CarryRule::Scheme;
    if (options.rule == AttributeRule::Interpolated) sets.push_back({attribute.name, attribute.values});
  }
  if (sets.empty()) return prepared;
  InterpolateOptions solve = options.solve;
  if (solve.on_singular == OnSingular::Alpha) solve.on_singular = OnSingular::LeastSquares;
  const Interpolator interpolator(topology, scheme, solve, progress_within(progress, 0.0, kBuilt));
  std::vector<Interpolant> results = interpolator.solve_together(sets, progress_within(progress, kBuilt, 1.0));
  auto solved = results.begin();
  for (Attribute& attribute : prepared.mesh.attributes) {
    if (!is_value_at_vertices(attribute)) continue;
    attribute.values = std::move(solved->control);
    prepared.reports.push_back(std::move(solved->report));
    ++solved;
  }
  return prepared;
}

}  // namespace batten
