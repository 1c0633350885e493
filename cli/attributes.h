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

/// One row for each set of values that was solved for.
void add_value_rows(Table& table, const std::vector<InterpolationReport>& reports);
nlohmann::ordered_json solved_values_json(const std::vector<InterpolationReport>& reports);

/// Throws where values were missed. The output is written by then; the error gives the exit code.
void require_reached(const std::vector<InterpolationReport>& reports);

}  // namespace batten::cli
