#include "batten/expand/morph_surface.h"

#include <algorithm>
#include <utility>

#include "batten/error.h"

namespace batten {
namespace {

std::vector<double> key_times(const Morph& morph, int frames) {
  std::vector<double> times = morph.knots();
  for (int i = 0; i <= frames; ++i) times.push_back(static_cast<double>(i) / frames);
  std::sort(times.begin(), times.end());
  constexpr double kSame = 1e-9;
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return b - a < kSame; }), times.end());
  return times;
}

}  // namespace

MovingSurface morph_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Morph& morph,
                            int levels, int frames, double seconds, const Progress& progress) {
  if (frames < 1 || !(seconds > 0.0)) {
    throw Error(ErrorCode::BadArgument, "an animation needs a frame and a duration above 0, not " +
                                            std::to_string(frames) + " and " + std::to_string(seconds) + " seconds");
  }
  const std::size_t count = morph.targets().size();
  Mesh base = control;
  base.points = morph.base();
  const std::vector<double> knots = morph.knots();
  std::vector<Points> shapes;
  std::vector<double> weights;
  for (std::size_t i = 0; i < count; ++i) {
    // Only this target has a weight at its knot. The last one fades to zero and is evaluated on the way.
    double weight = 0.0;
    for (const double knot : knots) weight = std::max(weight, morph.weights(knot)[i]);
    if (weight == 0.0) weight = 0.25 / static_cast<double>(count);
    shapes.emplace_back(morph.base() + weight * morph.targets()[i]);
    weights.push_back(weight);
  }
  MovingSurface result = moving_surface(topology, scheme, base, shapes, levels, progress);
  for (std::size_t i = 0; i < count; ++i) {
    result.targets.displacements[i] /= weights[i];
    result.targets.normals[i] /= weights[i];
  }
  const std::vector<double> times = key_times(morph, frames);
  result.targets.weights.resize(static_cast<Eigen::Index>(times.size()), static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::vector<double> row = morph.weights(times[k]);
    for (std::size_t i = 0; i < count; ++i) {
      result.targets.weights(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = row[i];
    }
    result.targets.times.push_back(seconds * times[k]);
  }
  return result;
}

}  // namespace batten
