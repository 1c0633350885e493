#include "batten/interpolate/fair_mesh.h"

#include <utility>

#include "batten/progress.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace batten {

FairMesh interpolate_fairly(const Topology& topology, const Scheme& scheme, Mesh mesh, AttributeRule rule,
                            const FairOptions& options, const Progress& progress) {
  FairInterpolant fair =
      interpolate_fairly(topology, scheme, mesh.points, options, progress_within(progress, 0.0, 0.8));
  InterpolateOptions plain_options;
  plain_options.refined = RefinedExtent::Everything;
  const Interpolator interpolator(topology, scheme, plain_options, progress_within(progress, 0.8, 0.85));
  InterpolatedMesh plain = interpolate(interpolator, std::move(mesh), rule, progress_within(progress, 0.85, 0.95));
  const int left = fair.report.levels - (plain.is_refined ? 1 : 0);
  RefinedMesh refined =
      refine_mesh(plain.topology, plain.scheme, plain.mesh, left, progress_within(progress, 0.95, 1.0));
  Values plain_points = refined.mesh.points;
  refined.mesh.points = fair.control;
  state_scheme(fair.scheme, refined.mesh);
  plain.reports.erase(plain.reports.begin());
  return {std::move(refined.mesh), std::move(plain_points), fair.topology, fair.scheme,
          std::move(fair.report),  std::move(plain.reports)};
}

}  // namespace batten
