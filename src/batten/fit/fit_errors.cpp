#include "batten/fit/fit_errors.h"

#include <algorithm>
#include <cmath>

#include "batten/quantile.h"

namespace batten {

FitErrors fit_errors(const Scalars& distances, const Buffer<std::uint8_t>& outliers, double diameter) {
  constexpr double kBulk = 0.95;
  Buffer<double> followed;
  for (std::size_t i = 0; i < outliers.size(); ++i) {
    if (outliers[i] == 0) followed.push_back(distances[static_cast<Eigen::Index>(i)]);
  }
  FitErrors errors;
  if (followed.empty()) return errors;
  const double cut = quantile(followed, kBulk);
  double squares = 0.0;
  double of_bulk = 0.0;
  double bulk = 0.0;
  for (const double distance : followed) {
    squares += distance * distance;
    errors.max = std::max(errors.max, distance / diameter);
    if (distance > cut) continue;
    of_bulk += distance * distance;
    bulk += 1.0;
  }
  errors.rms = std::sqrt(squares / static_cast<double>(followed.size())) / diameter;
  errors.bulk = std::sqrt(of_bulk / bulk) / diameter;
  return errors;
}

}  // namespace batten
