#include "batten/expand/strength.h"

#include <cmath>
#include <numbers>

#include "batten/error.h"

namespace batten {

double wave_remainder(SchemeKind kind, SeriesMatrix matrix, double edges) {
  const double wave = 2.0 * std::numbers::pi / edges;
  const double along = 1.0 - std::cos(wave);
  const double slanting = 1.0 - std::cos(0.5 * wave);  // triangles: four of the six edges lean by 60 degrees
  if (matrix == SeriesMatrix::Cotangent) {
    return kind == SchemeKind::Loop ? 4.0 / 9.0 * (2.0 * along + 4.0 * slanting) / 6.0 : 4.0 / 9.0 * along / 2.0;
  }
  return kind == SchemeKind::Loop ? (2.0 * along + 4.0 * slanting) / 12.0 : along / 3.0;
}

namespace {

/// The number of halvings of a wave that one pass amounts to.
double halvings(SchemeKind kind, SeriesMatrix matrix, int m, double edges) {
  return std::log1p(-std::pow(wave_remainder(kind, matrix, edges), m + 1)) / -std::numbers::ln2;
}

}  // namespace

int passes_for(SchemeKind kind, SeriesMatrix matrix, int m, double edges) {
  constexpr double kMost = 1e6;
  if (!(edges >= 2.0)) throw Error(ErrorCode::BadArgument, "the shortest bump of a mesh is 2 edge lengths long");
  if (m < 0) throw Error(ErrorCode::BadArgument, "m must not be negative");
  const double passes = std::ceil(1.0 / halvings(kind, matrix, m, edges) - 1e-9);
  if (!(passes <= kMost)) {
    throw Error(ErrorCode::BadArgument,
                "so long bumps need more than a million passes; take a smaller m, shorter bumps or a coarser mesh");
  }
  return static_cast<int>(passes);
}

double halved_wavelength(SchemeKind kind, SeriesMatrix matrix, int m, int passes) {
  double low = 2.0;
  double high = 2.0;
  const auto halved = [&](double edges) { return passes * halvings(kind, matrix, m, edges) >= 1.0; };
  if (!halved(low)) return 0.0;
  while (halved(high)) high *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (halved(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace batten
