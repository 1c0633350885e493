/// \file How long operations report their progress and are cancelled.
#pragma once
#include "batten/types.h"

namespace batten {

/// Calls progress(done) if there is a callback. Throws Error(Cancelled) when it returns false.
void report_progress(const Progress& progress, double done);

/// Returns a callback for a part of an operation: 0 and 1 of the part become `begin` and `end` of the whole. It is
/// empty if `progress` is empty. `progress` must outlive it.
Progress progress_within(const Progress& progress, double begin, double end);

}  // namespace batten
