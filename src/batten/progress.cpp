#include "batten/progress.h"

#include <cmath>

#include "batten/error.h"

namespace batten {

void report_progress(const Progress& progress, double done) {
  if (progress && !progress(done)) throw Error(ErrorCode::Cancelled, "cancelled");
}

Progress progress_within(const Progress& progress, double begin, double end) {
  if (!progress) return {};
  return [&progress, begin, end](double done) { return progress(std::lerp(begin, end, done)); };
}

}  // namespace batten
