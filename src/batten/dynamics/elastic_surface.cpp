#include "batten/dynamics/elastic_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "batten/dynamics/force.h"
#include "batten/dynamics/turning_faces.h"
#include "batten/energy/congruence.h"
#include "batten/energy/face_coefficients.h"
#include "batten/energy/shape_energy.h"
#include "batten/energy/surface_energy.h"
#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/released_memory.h"
#include "batten/solve/sparse_product.h"
#include "batten/surface/quadrature.h"

namespace batten {

namespace {

using FaceCoefficients = std::vector<double>;

FaceCoefficients scaled(const FaceCoefficients& coefficients, double factor) {
  FaceCoefficients result = coefficients;
  for (double& value : result) value *= factor;
  return result;
}

/// The area of each face of the control mesh by that of its parameters: what a coefficient by parameters is more than
/// one by area.
Scalars area_ratios(const SurfacePatches& patches, const Points& control) {
  constexpr QuadratureOptions kAreaQuadrature{4, 2};
  const SurfaceQuadrature quadrature = surface_quadrature(patches, kAreaQuadrature);
  const Scalars weights = area_weights(LimitSurface(patches, control), quadrature);
  Scalars areas = Scalars::Zero(patches.topology().face_count());
  Scalars parameters = areas;
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    const Index face = patches.control_face(f);
    for (std::size_t p = quadrature.starts[f]; p < quadrature.starts[f + 1]; ++p) {
      areas[face] += weights[static_cast<Eigen::Index>(p)];
      parameters[face] += quadrature.weights[p];
    }
  }
  for (Index f = 0; f < areas.size(); ++f) areas[f] = parameters[f] > 0.0 ? areas[f] / parameters[f] : 0.0;
  return areas;
}

/// to += what. In place where the entries are the same.
void add_matrix(const ElasticSurface::Matrix& what, ElasticSurface::Matrix& to) {
  if (same_pattern(what, to)) {
    to.coeffs() += what.coeffs();
  } else {
    to += what;
  }
}

double quadratic_form(const ElasticSurface::Matrix& matrix, ConstValuesRef values) {
  Values product;
  multiply(matrix, values, product);
  return values.cwiseProduct(product).sum();
}

void require_points(const Topology& topology, ConstValuesRef values, const char* what) {
  if (values.rows() != topology.vertex_count() || values.cols() != 3) {
    throw Error(ErrorCode::BadShape, std::string(what) + " must have three columns and a row for each of the " +
                                         std::to_string(topology.vertex_count()) + " control points");
  }
  require_finite(values, what);
}

}  // namespace

struct ElasticSurface::Parts {
  SurfacePatches patches;
  ElasticOptions options;
  Points rest;
  double diagonal;
  Matrix mass;
  std::optional<double> damping_ratio;
  mutable std::once_flag damping_made;
  mutable Matrix damping;  ///< with a ratio made when it is asked for
  Matrix stiffness;
  std::unique_ptr<PlaceRows> first_step;  ///< S, where the base is a first refinement
  Points linear_force;                    ///< K R under Linear, or empty
  TurningFaces turning;                   ///< under Rotating

  Parts(const SurfacePatches& patches_in, ConstValuesRef rest_in, ElasticOptions options_in, const Progress& progress)
      : patches(patches_in), options(std::move(options_in)), rest(checked(rest_in)) {
    const BoundingBox box = bounding_box(rest);
    diagonal = (box.high - box.low).stableNorm();
    if (patches.has_first_step()) first_step = std::make_unique<PlaceRows>(first_step_rows(patches));
    make_mass(progress_within(progress, 0.0, 0.3));
    release_freed_memory(matrix_bytes());
    const Points base_rest = patches.base_values(rest);
    if (options.measure == ElasticMeasure::Lengths) {
      measure_lengths(base_rest, progress_within(progress, 0.3, 1.0));
    } else {
      measure_parameters(base_rest, progress_within(progress, 0.3, 1.0));
    }
    release_freed_memory(matrix_bytes());
    turning.finish(patches.base().vertex_count());
    if (options.rest == RestModel::Linear) {
      Values product;
      multiply(stiffness, rest, product);
      linear_force = product;
    }
    report_progress(progress, 1.0);
  }

  const ElasticMaterial& material() const { return options.material; }
  ConstValuesRef checked(ConstValuesRef rest_in) const {
    if (is_interpolating(patches.scheme().kind)) {
      throw Error(ErrorCode::BadArgument,
                  "the surfaces of the Butterflies have no energy; use Catmull-Clark or Loop for elastic surfaces");
    }
    if (options.cutoff_levels && options.measure == ElasticMeasure::Lengths) {
      throw Error(ErrorCode::BadArgument, "a cut-off is of energies by parameters, not by lengths");
    }
    const Index faces = patches.topology().face_count();
    require_coefficients(material().density, faces, "density");
    require_coefficients(material().damping, faces, "damping");
    require_coefficients(material().tension, faces, "tension");
    require_coefficients(material().rigidity, faces, "rigidity");
    require_points(patches.topology(), rest_in, "rest points");
    return rest_in;
  }

  /// Of the entries of one matrix.
  std::size_t matrix_bytes() const { return sizeof(double) * static_cast<std::size_t>(mass.nonZeros()); }
  void make_mass(const Progress& progress);
  void measure_lengths(const Points& base_rest, const Progress& progress);
  void measure_parameters(const Points& base_rest, const Progress& progress);
};

/// By lengths each face has its mass, spread evenly over its parameters.
void ElasticSurface::Parts::make_mass(const Progress& progress) {
  EnergyOptions by_density;
  by_density.density = material().density;
  EnergyOptions by_damping;
  by_damping.density = material().damping;
  if (options.measure == ElasticMeasure::Lengths) {
    const Scalars ratios = area_ratios(patches, rest);
    by_density.density.resize(static_cast<std::size_t>(ratios.size()));
    by_damping.density.resize(static_cast<std::size_t>(ratios.size()));
    for (Index f = 0; f < ratios.size(); ++f) {
      by_density.density[static_cast<std::size_t>(f)] = ratios[f] * coefficient_of(material().density, f);
      by_damping.density[static_cast<std::size_t>(f)] = ratios[f] * coefficient_of(material().damping, f);
    }
  }
  mass = SurfaceEnergy(patches, by_density).matrix(EnergyKind::Mass, progress_within(progress, 0.0, 0.5));
  if (material().density.size() == 1 && material().damping.size() == 1 && material().density[0] > 0.0) {
    damping_ratio = material().damping[0] / material().density[0];
  } else {
    damping = SurfaceEnergy(patches, by_damping).matrix(EnergyKind::Mass, progress_within(progress, 0.5, 1.0));
  }
}

void ElasticSurface::Parts::measure_lengths(const Points& base_rest, const Progress& progress) {
  const auto add = [&](ShapeEnergyKind kind, const FaceCoefficients& coefficients, const Progress& part) {
    const ShapeEnergy energy(patches, kind, kShapeQuadrature, progress_within(part, 0.0, 0.3));
    if (options.rest == RestModel::Rotating) {  // before the matrix, which takes more memory
      turning.add(energy.elements(), energy.element_gradients(base_rest, coefficients), base_rest);
    }
    release_freed_memory(matrix_bytes());
    return energy.matrix(base_rest, coefficients, progress_within(part, 0.3, 1.0));
  };
  Matrix stretch = add(ShapeEnergyKind::Stretch, material().tension, progress_within(progress, 0.0, 0.4));
  const Matrix bending = add(ShapeEnergyKind::Bending, material().rigidity, progress_within(progress, 0.4, 1.0));
  add_matrix(bending, stretch);
  if (first_step) {
    stiffness = congruence(stretch, first_step->rows);
  } else {
    stiffness.swap(stretch);
  }
}

void ElasticSurface::Parts::measure_parameters(const Points& base_rest, const Progress& progress) {
  EnergyOptions energy_options;
  energy_options.tension = material().tension;
  energy_options.rigidity = material().rigidity;
  energy_options.cutoff_levels = options.cutoff_levels;
  const SurfaceEnergy energy(patches, energy_options);
  stiffness = energy.matrix(EnergyKind::Stiffness, progress);
  if (options.rest != RestModel::Rotating) return;
  turning.add(energy.elements(), energy.element_gradients(EnergyKind::Stiffness, base_rest), base_rest);
}

ElasticSurface::ElasticSurface(const SurfacePatches& patches, ConstValuesRef rest, const ElasticOptions& options,
                               const Progress& progress)
    : parts_(std::make_shared<const Parts>(patches, rest, options, progress)) {}

ElasticSurface::ElasticSurface(const Topology& topology, const Scheme& scheme, ConstValuesRef rest,
                               const ElasticOptions& options, const Progress& progress)
    : ElasticSurface(SurfacePatches(topology, scheme, progress_within(progress, 0.0, 0.1)), rest, options,
                     progress_within(progress, 0.1, 1.0)) {}

const SurfacePatches& ElasticSurface::patches() const { return parts_->patches; }
const ElasticOptions& ElasticSurface::options() const { return parts_->options; }
const Points& ElasticSurface::rest() const { return parts_->rest; }
double ElasticSurface::diagonal() const { return parts_->diagonal; }
const ElasticSurface::Matrix& ElasticSurface::mass() const { return parts_->mass; }
const ElasticSurface::Matrix& ElasticSurface::damping() const {
  if (damping_ratio()) {
    std::call_once(parts_->damping_made, [&] { parts_->damping = parts_->mass * *damping_ratio(); });
  }
  return parts_->damping;
}
std::optional<double> ElasticSurface::damping_ratio() const { return parts_->damping_ratio; }
const ElasticSurface::Matrix& ElasticSurface::stiffness() const { return parts_->stiffness; }

void ElasticSurface::rest_force(ConstValuesRef positions, ValuesRef result) const {
  require_points(topology(), positions, "positions");
  require_shape(result, positions.rows(), 3);
  switch (options().rest) {
    case RestModel::Point:
      result.setZero();
      return;
    case RestModel::Linear:
      result = parts_->linear_force;
      return;
    case RestModel::Rotating:
      break;
  }
  Points of_base;
  parts_->turning.turn(patches().base_values(positions), &of_base);
  if (!parts_->first_step) {
    result = of_base;
    return;
  }
  Values product;
  multiply(parts_->first_step->transposed, of_base, product);
  result = product;
}

double ElasticSurface::energy(ConstValuesRef positions) const {
  require_points(topology(), positions, "positions");
  if (options().rest == RestModel::Linear) {
    return 0.5 * quadratic_form(stiffness(), positions - parts_->rest);
  }
  const double shape = 0.5 * quadratic_form(stiffness(), positions);
  if (options().rest == RestModel::Point) return shape;
  const double turned = parts_->turning.turn(patches().base_values(positions), nullptr);
  return shape - turned + parts_->turning.rest_energy();
}

Points ElasticSurface::force(ConstValuesRef positions) const {
  Points result(positions.rows(), 3);
  rest_force(positions, result);
  Values product;
  multiply(stiffness(), positions, product);
  result -= product;
  return result;
}

double ElasticSurface::kinetic_energy(ConstValuesRef velocities) const {
  require_points(topology(), velocities, "velocities");
  return 0.5 * quadratic_form(mass(), velocities);
}

namespace {

Refinement first_refinement(const ElasticSurface& surface) {
  const Scheme& scheme = surface.patches().scheme();
  return Refinement(with_surface_holes(surface.topology(), scheme), scheme);
}

}  // namespace

ElasticSurface ElasticSurface::refined(const Progress& progress) const {
  const Refinement step = first_refinement(*this);
  ElasticOptions child = options();
  // The parameters of a child's face run twice as fast, but where they were the child's own already.
  const bool halved = child.measure == ElasticMeasure::Parameters && !patches().has_first_step();
  for (FaceCoefficients* coefficients :
       {&child.material.density, &child.material.damping, &child.material.tension, &child.material.rigidity}) {
    *coefficients = child_coefficients(*coefficients, topology(), patches().quads());
  }
  if (halved) {
    child.material.density = scaled(child.material.density, 0.25);
    child.material.damping = scaled(child.material.damping, 0.25);
    child.material.rigidity = scaled(child.material.rigidity, 4.0);
  }
  return ElasticSurface(step.child(), patches().scheme().after_first_step(), step.apply(rest()), child, progress);
}

ElasticState state_at_rest(const ElasticSurface& surface) {
  return {0.0, surface.rest(), Points::Zero(surface.rest().rows(), 3)};
}

ElasticState refined_state(const ElasticSurface& surface, const ElasticState& state) {
  require_points(surface.topology(), state.positions, "positions");
  require_points(surface.topology(), state.velocities, "velocities");
  const Refinement step = first_refinement(surface);
  return {state.time, step.apply(state.positions), step.apply(state.velocities)};
}

}  // namespace batten
