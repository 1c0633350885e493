#include "batten/dynamics/pressure.h"

#include <Eigen/Geometry>
#include <utility>

#include "batten/dynamics/force_checks.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr std::ptrdiff_t kPressureBlock = 256;

bool is_closed_surface(const SurfacePatches& patches) {
  const Topology& topology = patches.topology();
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.twin(h) < 0) return false;
  }
  return patches.holes().empty();
}

/// Calls visit(sample, weight) for the places of [first, last) elements.
template <typename Visit>
void visit_samples(const SurfaceSamples& samples, std::ptrdiff_t first, std::ptrdiff_t last, const Visit& visit) {
  for (auto e = static_cast<Index>(first); e < static_cast<Index>(last); ++e) {
    const std::vector<double>& weights = samples.table(e).weights;
    const std::ptrdiff_t begin = samples.begin(e);
    for (std::size_t i = 0; i < weights.size(); ++i) visit(begin + static_cast<std::ptrdiff_t>(i), weights[i]);
  }
}

}  // namespace

/// V = 1/3 sum of w (s - c) . (du x dv), c the mean of the control points: no translation changes it.
struct Pressure::Volume {
  double value = 0.0;
  Points gradient;
};

Pressure::Volume Pressure::measure(const Points& positions) const {
  const Eigen::RowVector3d center = positions.colwise().mean();
  Points jets = samples_->evaluate(positions);
  using Sums = Eigen::Vector4d;  // the vector area, and the volume
  const Sums sums = parallel_reduce(
      samples_->elements().count(), Sums(Sums::Zero()),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        Sums sum = Sums::Zero();
        visit_samples(*samples_, first, last, [&](std::ptrdiff_t i, double weight) {
          const Eigen::RowVector3d s = jets.row(3 * i) - center;
          const Eigen::RowVector3d du = jets.row(3 * i + 1);
          const Eigen::RowVector3d dv = jets.row(3 * i + 2);
          const Eigen::RowVector3d normal = weight / 3.0 * du.cross(dv);
          sum.head<3>() += normal.transpose();
          sum[3] += s.dot(normal);
          jets.row(3 * i) = normal;
          jets.row(3 * i + 1) = weight / 3.0 * dv.cross(s);
          jets.row(3 * i + 2) = weight / 3.0 * s.cross(du);
        });
        return sum;
      },
      [](const Sums& a, const Sums& b) { return Sums(a + b); }, kPressureBlock);
  Volume volume{sums[3], samples_->pull_back(jets)};
  volume.gradient.rowwise() -= sums.head<3>().transpose() / static_cast<double>(positions.rows());
  return volume;
}

Points Pressure::open_force(const Points& positions) const {
  const Points jets = samples_->evaluate(positions);
  Points forces(samples_->count(), 3);
  parallel_for(
      samples_->elements().count(),
      [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        visit_samples(*samples_, first, last, [&](std::ptrdiff_t i, double weight) {
          const Eigen::RowVector3d du = jets.row(3 * i + 1);
          const Eigen::RowVector3d dv = jets.row(3 * i + 2);
          forces.row(i) = weight * du.cross(dv);
        });
      },
      kPressureBlock);
  return samples_->pull_back(forces);
}

Pressure::Pressure(const ElasticSurface& body, PressureOptions options)
    : options_(std::move(options)),
      samples_(std::make_shared<const SurfaceSamples>(body.patches(), GaussSamples{options_.quadrature})),
      closed_(is_closed_surface(body.patches())) {
  require_not_negative(options_.bulk_modulus, "the bulk modulus of a pressure");
  if (options_.volume && !closed_)
    throw Error(ErrorCode::BadArgument, "the surface is open and has no volume to hold; close it, or give a pressure");
  if (!options_.pressure && !options_.volume)
    throw Error(ErrorCode::BadArgument, "a pressure needs a pressure or a volume");
}

Pressure::Pressure(const ElasticSurface& body, double pressure)
    : Pressure(body, PressureOptions{.pressure = always(pressure)}) {
  require_finite_number(pressure, "the pressure");
}

double Pressure::volume(const Points& positions) const { return measure(positions).value; }
Points Pressure::volume_gradient(const Points& positions) const { return measure(positions).gradient; }

void Pressure::add(const ForceInput& input, ForceSum& sum) const {
  const std::string when = " at " + std::to_string(input.time) + " s";
  double pressure = options_.pressure ? options_.pressure(input.time) : 0.0;
  require_finite_number(pressure, "the pressure" + when);
  if (!closed_) {
    sum.force += pressure * open_force(input.positions);
    return;
  }
  Volume volume = measure(input.positions);
  sum.energy -= pressure * volume.value;
  if (!options_.volume) {
    sum.force += pressure * volume.gradient;
    return;
  }
  const double target = options_.volume(input.time);
  require_finite_number(target, "the volume of a pressure" + when);
  if (target <= 0.0) throw Error(ErrorCode::BadArgument, "the volume of a pressure" + when + " is not above 0");
  const double excess = volume.value / target - 1.0;
  pressure -= options_.bulk_modulus * excess;
  sum.energy += 0.5 * options_.bulk_modulus * target * excess * excess;
  sum.force += pressure * volume.gradient;
  sum.along.push_back({options_.bulk_modulus / target, std::move(volume.gradient)});
}

std::shared_ptr<const Force> Pressure::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<Pressure>(child, options_);
}

}  // namespace batten
