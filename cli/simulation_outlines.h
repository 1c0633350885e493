/// \file What a picture of a simulation shows besides the body.
#pragma once
#include "batten/dynamics/elastic_run.h"

namespace batten::cli {

/// The springs at a time for these control points of the mesh of now, and the obstacles as lines: of planes as much as
/// lies below or beside the box from `low` to `high`.
Mesh outlines_of(const ElasticRun& run, const Points& positions, double time, const Eigen::RowVector3d& low,
                 const Eigen::RowVector3d& high);

}  // namespace batten::cli
