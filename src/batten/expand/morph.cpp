#include "batten/expand/morph.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/progress.h"

namespace batten {
namespace {

constexpr int kMostStages = 10;  // 4^9 smoothings
constexpr int kLargestM = 1000;

void require_m(int m) {
  if (m >= 0 && m <= kLargestM) return;
  throw Error(ErrorCode::BadArgument, "m must lie in [0, 1000], but is " + std::to_string(m));
}

void require_ends(const Topology& topology, ConstValuesRef from, ConstValuesRef to) {
  require_vertex_rows(topology, from);
  require_vertex_rows(topology, to);
  if (from.cols() == to.cols()) return;
  throw Error(ErrorCode::BadShape, "both ends of a morph must have as many columns, not " +
                                       std::to_string(from.cols()) + " and " + std::to_string(to.cols()));
}

void require_time(double t) {
  if (t >= 0.0 && t <= 1.0) return;
  throw Error(ErrorCode::BadArgument, "the time of a morph lies in [0, 1], not at " + std::to_string(t));
}

/// The number of smoothings of the difference in target i: 0, 1, 4, 16, ...
int smoothings(int target) { return target == 0 ? 0 : 1 << 2 * (target - 1); }

}  // namespace

Morph::Morph(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to, const MorphOptions& options,
             const Progress& progress)
    : options_(options), from_(from), to_(to) {
  require_ends(series.topology(), from, to);
  require_m(options.m);
  if (options.stages < 0 || options.stages > kMostStages) {
    throw Error(ErrorCode::BadArgument, "a morph has 0 to 10 stages, not " + std::to_string(options.stages));
  }
  targets_.push_back(options.order == MorphOrder::LowLast ? from - to : to - from);
  for (int i = 1; i <= options.stages; ++i) {
    const double all = smoothings(options.stages);
    const Progress part = progress_within(progress, smoothings(i - 1) / all, smoothings(i) / all);
    targets_.push_back(series.smooth(targets_.back(), options.m, smoothings(i) - smoothings(i - 1), part));
  }
  if (options.stages == 0) report_progress(progress, 1.0);
}

std::vector<double> Morph::weights(double t) const {
  require_time(t);
  const double left = options_.order == MorphOrder::LowLast ? 1.0 - t : t;
  const double place = (1.0 - left) * options_.stages;
  std::vector<double> weights(targets_.size(), 0.0);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = left * std::max(0.0, 1.0 - std::abs(place - static_cast<double>(i)));
  }
  return weights;
}

std::vector<double> Morph::knots() const {
  const int pieces = std::max(options_.stages, 1);
  std::vector<double> times;
  for (int i = 0; i <= pieces; ++i) times.push_back(static_cast<double>(i) / pieces);
  return times;
}

Values Morph::at(double t) const {
  const std::vector<double> weight = weights(t);
  if (t == 0.0) return from_;
  if (t == 1.0) return to_;
  Values shape = base();
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] != 0.0) shape += weight[i] * targets_[i];
  }
  return shape;
}

std::vector<Values> morph_sequence(const MeshSeries& series, ConstValuesRef from, ConstValuesRef to,
                                   const MorphSequenceOptions& options, const Progress& progress) {
  require_ends(series.topology(), from, to);
  require_m(options.m);
  if (!(options.rho > 0.0 && options.rho <= 1.0) || options.steps < 0) {
    throw Error(ErrorCode::BadArgument, "a morph needs rho in (0, 1] and no less than 0 steps, not rho " +
                                            std::to_string(options.rho) + " and " + std::to_string(options.steps));
  }
  Values difference = from - to;
  ValueRow offset = ValueRow::Zero(from.cols());
  if (options.align && from.rows() > 0) offset = series.weighted_centroid(difference);
  difference.rowwise() -= offset;
  std::vector<Values> sequence{Values(from)};
  for (int k = 1; k <= options.steps; ++k) {
    const Progress part =
        progress_within(progress, static_cast<double>(k - 1) / options.steps, static_cast<double>(k) / options.steps);
    difference = options.rho * series.smooth(difference, options.m, 1, part);
    const double left = 1.0 - static_cast<double>(k) / options.steps;
    sequence.emplace_back((to + difference).rowwise() + left * offset);
  }
  return sequence;
}

}  // namespace batten
