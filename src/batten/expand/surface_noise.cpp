#include "batten/expand/surface_noise.h"

#include <cmath>
#include <utility>

#include "batten/error.h"
#include "batten/expand/solid_noise.h"
#include "batten/interpolate/interpolator.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mixed_bits.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refined_values.h"
#include "batten/refine/refinement.h"

namespace batten {
namespace {

constexpr double kLargestFrequency = 1e6;
constexpr int kMostOctaves = 24;
/// The greatest edge length of a level that samples an octave, in units of the octave's features.
constexpr double kSampling = 0.5;

/// One octave of one noise.
struct Octave {
  Eigen::Index column;
  int level;
  double amplitude;
  Eigen::Vector3d frequency;  ///< of coordinates in diagonals
  std::uint32_t seed;
};

void check(const NoiseOptions& noise) {
  const bool in_range = noise.frequency > 0.0 && noise.frequency <= kLargestFrequency && noise.octaves >= 1 &&
                        noise.octaves <= kMostOctaves && noise.gain >= 0.0 && noise.gain <= 4.0 &&
                        noise.stretch.minCoeff() > 0.0 && noise.stretch.allFinite();
  if (in_range) return;
  throw Error(ErrorCode::BadArgument,
              "noise needs a frequency above 0 and at most 1e6, 1 to 24 octaves, a gain in [0, 4] and stretches above "
              "0, not frequency " +
                  std::to_string(noise.frequency) + ", " + std::to_string(noise.octaves) + " octaves, gain " +
                  std::to_string(noise.gain));
}

/// The seed and the octave, mixed and folded to 32 bits.
std::uint32_t octave_seed(std::uint64_t seed, int octave) {
  const std::uint64_t z = mixed_bits(seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(octave) + 1));
  return static_cast<std::uint32_t>(z ^ (z >> 32U));
}

/// The places where noise is sampled: the surface's points in diagonals, relative to the middle of their box.
struct Places {
  ConstValuesRef points;
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  double diagonal = 1.0;

  explicit Places(ConstValuesRef surface) : points(surface) {
    if (points.rows() == 0) return;
    const Eigen::RowVector3d lowest = points.colwise().minCoeff();
    const Eigen::RowVector3d highest = points.colwise().maxCoeff();
    centre = 0.5 * lowest + 0.5 * highest;
    const double length = (highest - lowest).norm();
    if (length > 0.0) diagonal = length;
  }
  Eigen::Vector3d at(Eigen::Index vertex) const { return (points.row(vertex) - centre).transpose() / diagonal; }
};

/// The root mean square of the edges' lengths in diagonals. Long edges, which have few samples on much surface,
/// dominate it.
double edge_length(const Topology& topology, const Places& places) {
  if (topology.edge_count() == 0) return 0.0;
  const double squares = parallel_reduce<double>(
      topology.edge_count(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double sum = 0.0;
        for (auto e = static_cast<Index>(begin); e < end; ++e) {
          const Index h = topology.edge_half_edge(e);
          sum += (places.at(topology.origin(h)) - places.at(topology.destination(h))).squaredNorm();
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
  return std::sqrt(squares / topology.edge_count());
}

std::vector<Octave> octaves_of(std::span<const NoiseOptions> noises, double edge, int levels) {
  std::vector<Octave> octaves;
  for (std::size_t n = 0; n < noises.size(); ++n) {
    const NoiseOptions& noise = noises[n];
    check(noise);
    double squares = 0.0;
    for (int i = 0; i < noise.octaves; ++i) squares += std::pow(noise.gain, 2 * i);
    for (int i = 0; i < noise.octaves; ++i) {
      const double frequency = std::ldexp(noise.frequency, i);
      int level = 0;
      while (level < levels && std::ldexp(edge, -level) * frequency > kSampling) ++level;
      octaves.push_back({static_cast<Eigen::Index>(n), level, std::pow(noise.gain, i) / std::sqrt(squares),
                         frequency * noise.stretch.cwiseInverse(), octave_seed(noise.seed, i)});
    }
  }
  return octaves;
}

/// The sum of the random numbers of all octaves of a level.
Values numbers_at(const std::vector<Octave>& octaves, int level, const Places& places, Values numbers,
                  const Progress& progress) {
  numbers.setZero();
  constexpr std::ptrdiff_t kBlock = 512;  // about a microsecond each
  parallel_for(
      numbers.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (const Octave& octave : octaves) {
          if (octave.level != level) continue;
          for (std::ptrdiff_t v = begin; v < end; ++v) {
            numbers(v, octave.column) +=
                octave.amplitude * solid_noise(octave.frequency.cwiseProduct(places.at(v)), octave.seed);
          }
        }
      },
      kBlock, progress);
  return numbers;
}

bool any_at(const std::vector<Octave>& octaves, int level) {
  for (const Octave& octave : octaves) {
    if (octave.level == level) return true;
  }
  return false;
}

}  // namespace

SurfaceNoise::SurfaceNoise(const Topology& topology, const Scheme& scheme, int levels, const Progress& progress)
    : topology_(topology), scheme_(scheme) {
  if (levels < 0) throw Error(ErrorCode::BadArgument, "levels must not be negative");
  for (int i = 0; i < levels; ++i) {
    const Progress part = progress_within(progress, std::ldexp(1.0, -2 * (levels - i)) * (i > 0 ? 1.0 : 0.0),
                                          std::ldexp(1.0, -2 * (levels - i - 1)));
    refined_.push_back(Refinement(level(i), i > 0 ? scheme.after_first_step() : scheme, {}, part).child());
  }
}

Values SurfaceNoise::refined_once(int from, const Scheme& scheme, ConstValuesRef control,
                                  const Progress& progress) const {
  Values finer(level(from + 1).vertex_count(), control.cols());
  refine_values(level(from), scheme, {}, control, finer.data(), progress);
  return finer;
}

Values SurfaceNoise::values(ConstValuesRef points, std::span<const NoiseOptions> noises,
                            const Progress& progress) const {
  if (points.rows() != vertex_count() || points.cols() != 3) {
    throw Error(ErrorCode::BadShape, "the noise needs one place of three coordinates for each of the " +
                                         std::to_string(vertex_count()) + " vertices of the finest level, not " +
                                         std::to_string(points.rows()) + " by " + std::to_string(points.cols()));
  }
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    if (points.row(v).allFinite()) continue;
    throw Error(ErrorCode::NotFinite, "the place of vertex " + std::to_string(v) + " is not finite");
  }
  const Places places(points);
  const std::vector<Octave> octaves = octaves_of(noises, edge_length(topology_, places), levels());
  Values control;  // of all coarser levels; empty while there is none
  Scheme scheme = scheme_;
  InterpolateOptions whole_steps;  // a refined component alone would be no step of the levels
  whole_steps.refined = RefinedExtent::Everything;
  for (int i = 0; i < levels(); ++i) {
    const double begin = i > 0 ? std::ldexp(1.0, -2 * (levels() - i)) : 0.0;
    const double end = std::ldexp(1.0, -2 * (levels() - i - 1));
    const Progress part = progress_within(progress, 0.5 * begin, 0.5 * end);
    Values finer;
    if (control.size() > 0) finer = refined_once(i, scheme, control, progress_within(part, 0.0, 0.1));
    if (any_at(octaves, i)) {
      const Values numbers =
          numbers_at(octaves, i, places, Values(level(i).vertex_count(), static_cast<Eigen::Index>(noises.size())),
                     progress_within(part, 0.1, 0.5));
      Interpolant through = Interpolator(level(i), scheme, whole_steps, progress_within(part, 0.5, 0.6))
                                .solve(numbers, progress_within(part, 0.6, 0.9));
      const bool is_refined = through.topology.vertex_count() > level(i).vertex_count();
      Values own = is_refined ? std::move(through.control)
                              : refined_once(i, scheme, through.control, progress_within(part, 0.9, 1.0));
      if (finer.size() > 0) {
        finer += own;
      } else {
        finer.swap(own);
      }
    }
    control = std::move(finer);
    scheme = scheme.after_first_step();
  }
  Values sum = control.size() > 0 ? LimitMatrix(level(levels()), scheme, {}, progress_within(progress, 0.5, 0.55))
                                        .apply(control, progress_within(progress, 0.55, 0.6))
                                  : Values(Values::Zero(vertex_count(), static_cast<Eigen::Index>(noises.size())));
  // At the finest level the control values are the interpolated numbers themselves.
  if (any_at(octaves, levels())) {
    sum += numbers_at(octaves, levels(), places, Values(sum.rows(), sum.cols()), progress_within(progress, 0.6, 1.0));
  }
  return sum;
}

}  // namespace batten
