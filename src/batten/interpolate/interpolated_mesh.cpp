#include "batten/interpolate/interpolated_mesh.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/progress.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

constexpr double kSolved = 0.9;  // of the time

/// The mesh refined once without its values at vertices: those are the caller's. `step` has what refines the rest.
template <typename Step>
Mesh refined_labels(const Topology& child, const Scheme& scheme, const Step& step, Mesh mesh) {
  Mesh refined = mesh_from_topology(child);
  refined.groups = step.groups(std::move(mesh.groups));
  refined.material_libraries = std::move(mesh.material_libraries);
  refined.crease_method = mesh.crease_method;
  refined.triangle_rule = mesh.triangle_rule;
  for (Attribute& attribute : mesh.attributes) {
    if (attribute.per_corner()) attribute = step.at_corners(scheme, attribute);
  }
  refined.attributes = std::move(mesh.attributes);
  return refined;
}

/// A step on all components, as PartRefinement is one on some.
struct WholeStep {
  const Topology& topology;
  SchemeKind kind;

  Attribute at_corners(const Scheme& scheme, const Attribute& attribute) const {
    return refine_at_corners(topology, scheme, attribute);
  }
  std::vector<Group> groups(std::vector<Group> given) const { return refine_groups(topology, kind, std::move(given)); }
};

/// Where the scheme itself has alpha, the surface is an ordinary one from its first step on.
void make_ordinary(const Scheme& scheme, std::vector<Interpolant>& results, const Progress& progress) {
  if (results.front().scheme.alpha == 0.0) return;
  for (Interpolant& result : results) result.scheme = scheme.after_first_step();
  if (scheme.kind != SchemeKind::CatmullClark) return;
  const bool adds_holes = scheme.boundary == BoundaryRule::None;
  const Topology& topology = results.front().topology;
  const Refinement step(adds_holes ? with_surface_holes(topology, scheme) : topology, scheme, {},
                        progress_within(progress, 0.0, 0.5));
  const auto count = static_cast<double>(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double begin = 0.5 + 0.5 * static_cast<double>(i) / count;
    results[i].control = step.apply(results[i].control, progress_within(progress, begin, begin + 0.5 / count));
    results[i].topology = step.child();
  }
}

/// Values that were not solved for, on what was refined once.
Values refined_once(const Interpolator& interpolator, const PartRefinement* part, const Attribute& attribute) {
  const Topology& topology = interpolator.topology();
  const Scheme& scheme = interpolator.scheme();
  const Values all = attribute.carry == CarryRule::Midpoint ? refine_midpoints(topology, scheme.kind, attribute.values)
                                                            : Refinement(topology, scheme).apply(attribute.values);
  return part != nullptr ? part->choose(attribute.values, all) : all;
}

}  // namespace

bool InterpolatedMesh::converged() const {
  return std::all_of(reports.begin(), reports.end(), [](const InterpolationReport& one) { return one.converged(); });
}

InterpolatedMesh interpolate(const Interpolator& interpolator, Mesh mesh, const Progress& progress) {
  return interpolate(interpolator, std::move(mesh), AttributeRule::Interpolated, progress);
}

InterpolatedMesh interpolate(const Interpolator& interpolator, Mesh mesh, AttributeRule rule,
                             const Progress& progress) {
  const bool solves = rule == AttributeRule::Interpolated;
  std::erase_if(mesh.attributes, [](const Attribute& attribute) { return attribute.name == "normal"; });
  std::vector<Targets> sets{{"points", mesh.points}};
  for (const Attribute& attribute : mesh.attributes) {
    if (!attribute.per_corner() && solves) sets.push_back({attribute.name, attribute.values});
  }
  std::vector<Interpolant> results = interpolator.solve_together(sets, progress_within(progress, 0.0, kSolved));
  make_ordinary(interpolator.scheme(), results, progress_within(progress, kSolved, 1.0));
  InterpolatedMesh result{{}, results.front().topology, results.front().scheme, {}, false};
  result.is_refined = result.topology.vertex_count() != interpolator.topology().vertex_count();
  const std::shared_ptr<const PartRefinement> part = results.front().part;
  const Scheme& scheme = interpolator.scheme();
  const WholeStep whole{interpolator.topology(), scheme.kind};
  result.mesh = !result.is_refined ? std::move(mesh)
                : part != nullptr  ? refined_labels(result.topology, scheme, *part, std::move(mesh))
                                   : refined_labels(result.topology, scheme, whole, std::move(mesh));
  auto solved = results.begin();
  result.mesh.points = solved->control;
  for (Attribute& attribute : result.mesh.attributes) {
    if (attribute.per_corner()) continue;
    attribute.carry = rule == AttributeRule::Midpoint ? CarryRule::Midpoint : CarryRule::Scheme;
    if (solves) {
      attribute.values = std::move((++solved)->control);
    } else if (result.is_refined) {
      attribute.values = refined_once(interpolator, part.get(), attribute);
    }
  }
  for (Interpolant& one : results) result.reports.push_back(std::move(one.report));
  state_scheme(result.scheme, result.mesh);
  return result;
}

InterpolatedMesh interpolate(const Mesh& mesh, const InterpolateOptions& options, const Progress& progress) {
  const Topology topology(mesh, progress_within(progress, 0.0, 0.3));
  const Interpolator interpolator(topology, choose_scheme(mesh), options, progress_within(progress, 0.3, 0.7));
  return interpolate(interpolator, mesh, progress_within(progress, 0.7, 1.0));
}

}  // namespace batten
