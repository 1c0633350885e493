/// \file What --attributes and --face-varying do with the values of a mesh.
#pragma once
#include <vector>

#include "batten/interpolate/attributes.h"
#include "cli/job.h"

namespace batten::cli {

/// Throws UsageError where --attributes or --face-varying has no values of the mesh to act on.
void require_values(const CommonArguments& common, const Mesh& mesh);

/// Makes refinement carry the values at the vertices of the job's mesh as --attributes says, by the scheme if it is not
/// given. Counts as a stage where they are solved for. Returns a report for each that was.
std::vector<InterpolationReport> prepare_values(const Topology& topology, const Scheme& scheme, Job& job);

}  // namespace batten::cli
