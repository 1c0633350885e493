/// \file How long work reports and is cancelled: what stands behind every `progress` parameter.
#pragma once
#include "batten/types.h"

namespace batten {

/// Calls progress(done), if there is one. Throws Error(Cancelled) when it returns false.
void report_progress(const Progress& progress, double done);

/// A callback for a part of an operation: the part's 0 and 1 are the whole's `begin` and `end`. Empty where `progress`
/// is, which must outlive it.
Progress progress_within(const Progress& progress, double begin, double end);

}  // namespace batten
