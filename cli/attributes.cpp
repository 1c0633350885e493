#include "cli/attributes.h"

#include <algorithm>
#include <utility>

#include "cli/usage_error.h"

namespace batten::cli {

void require_values(const CommonArguments& common, const Mesh& mesh) {
  const auto has_values = [&](bool at_corners) {
    return std::any_of(mesh.attributes.begin(), mesh.attributes.end(), [&](const Attribute& attribute) {
      return attribute.name != "normal" && attribute.per_corner() == at_corners;
    });
  };
  if (common.attributes && !has_values(false)) {
    throw UsageError("--attributes does nothing for " + common.input + ", which has no values at its vertices");
  }
  if (common.face_varying && !has_values(true)) {
    throw UsageError("--face-varying does nothing for " + common.input +
                     ", which has no texture coordinates or other values at its corners");
  }
}

std::vector<InterpolationReport> prepare_values(const Topology& topology, const Scheme& scheme, Job& job) {
  AttributeOptions options;
  options.rule = job.common.attributes.value_or(AttributeRule::Scheme);
  ProgressBar bar("solving for values", job.common.quiet);
  PreparedAttributes prepared = prepare_attributes(topology, scheme, std::move(job.mesh), options, bar.callback());
  job.mesh = std::move(prepared.mesh);
  if (!prepared.reports.empty()) job.stages.finish("values");
  return std::move(prepared.reports);
}

}  // namespace batten::cli
