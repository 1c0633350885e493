/// \file The verb interpolate with --from.
#pragma once
#include "cli/arguments.h"

namespace batten::cli {

/// Moves the control points of the mesh arguments.from, so that its surface passes through the points of the input that
/// it misses. Returns the exit code.
int run_interpolate_from(const InterpolateArguments& arguments);

}  // namespace batten::cli
