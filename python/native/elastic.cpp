#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <tuple>

#include "batten/dynamics/contact.h"
#include "batten/dynamics/drag.h"
#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/gravity.h"
#include "batten/dynamics/pressure.h"
#include "batten/dynamics/spring.h"
#include "batten/energy/surface_energy.h"
#include "batten/progress.h"
#include "batten/surface/surface_weights.h"
#include "native/arrays.h"
#include "native/bind.h"
#include "native/calls.h"
#include "native/places.h"
#include "native/sparse.h"
#include "native/words.h"

namespace batten::python {

namespace {

using Vector = Eigen::Vector3d;

const Words<EnergyKind> kEnergies{{"mass", EnergyKind::Mass},
                                  {"membrane", EnergyKind::Membrane},
                                  {"thin-plate", EnergyKind::ThinPlate},
                                  {"stiffness", EnergyKind::Stiffness}};
const Words<RestModel> kRestModels{
    {"rotating", RestModel::Rotating}, {"linear", RestModel::Linear}, {"point", RestModel::Point}};
const Words<TimeScheme> kTimeSchemes{{"backward-euler", TimeScheme::BackwardEuler},
                                     {"second-order", TimeScheme::SecondOrder},
                                     {"mass-free", TimeScheme::MassFree},
                                     {"paper", TimeScheme::Paper},
                                     {"paper-mass-free", TimeScheme::PaperMassFree}};

ElasticSurface make_body(const Topology& topology, const Scheme& scheme, const Doubles& rest,
                         const ElasticMaterial& material, const std::string& rest_model, const py::object& progress) {
  ElasticOptions options;
  options.material = material;
  options.rest = choice_of(rest_model, kRestModels, "the rest model");
  const Eigen::Map<const Values> rows = points_of(rest, "rest points");
  return run(progress, [&](const Progress& report) { return ElasticSurface(topology, scheme, rows, options, report); });
}

Eigen::Map<const Values> targets_of(const std::vector<SurfacePlace>& places, const Doubles& targets) {
  const Eigen::Map<const Values> to = points_of(targets, "targets");
  if (to.rows() != static_cast<Eigen::Index>(places.size())) {
    throw Error(ErrorCode::BadShape, "there are " + std::to_string(to.rows()) + " targets for " +
                                         std::to_string(places.size()) + " places; give one each");
  }
  return to;
}

/// Forces and supports of a motion, gathered one by one.
struct Loads {
  explicit Loads(const ElasticSurface& body_in) : body(body_in) {}
  ElasticSurface body;
  std::vector<std::shared_ptr<const Force>> forces = {};
  Supports supports = {};

  void add_springs(const Indices& faces, const Doubles& uv, const Doubles& targets, double stiffness) {
    const std::vector<SurfacePlace> places = places_of(faces, uv);
    const Eigen::Map<const Values> to = targets_of(places, targets);
    std::vector<PointSprings::Spring> springs;
    for (std::size_t i = 0; i < places.size(); ++i) {
      springs.push_back({places[i], stay_at(to.row(static_cast<Eigen::Index>(i)).transpose()), stiffness});
    }
    forces.push_back(std::make_shared<PointSprings>(body, std::move(springs)));
  }
  void add_gravity(const Vector& acceleration) { forces.push_back(std::make_shared<Gravity>(body, acceleration)); }
  void add_pressure(double pressure) { forces.push_back(std::make_shared<Pressure>(body, pressure)); }
  void add_volume(double volume, double bulk_modulus) {
    PressureOptions options;
    options.volume = always(volume);
    options.bulk_modulus = bulk_modulus;
    forces.push_back(std::make_shared<Pressure>(body, options));
  }
  void add_wind(const Vector& velocity, double normal, double tangential) {
    DragOptions options;
    options.wind = steady_wind(velocity);
    options.normal = normal;
    options.tangential = tangential;
    forces.push_back(std::make_shared<Drag>(body, options));
  }
  void add_plane(const Vector& point, const Vector& normal, double stiffness, double friction) {
    add_contact(plane_obstacle(point, normal), stiffness, friction);
  }
  void add_sphere(const Vector& center, double radius, double stiffness, double friction) {
    add_contact(sphere_obstacle(center, radius), stiffness, friction);
  }
  void hold(const Indices& vertices) {
    for (py::ssize_t i = 0; i < vertices.size(); ++i) {
      const Index vertex = vertices.data()[i];
      if (vertex < 0 || vertex >= body.topology().vertex_count()) {
        throw Error(ErrorCode::IndexOutOfRange, "there is no vertex " + std::to_string(vertex) + " to hold");
      }
      supports.points.push_back({vertex, stay_at(body.rest().row(vertex).transpose())});
    }
  }
  void pin(const Indices& faces, const Doubles& uv, const Doubles& targets) {
    const std::vector<SurfacePlace> places = places_of(faces, uv);
    const Eigen::Map<const Values> to = targets_of(places, targets);
    for (std::size_t i = 0; i < places.size(); ++i) {
      supports.pins.push_back({places[i], stay_at(to.row(static_cast<Eigen::Index>(i)).transpose())});
    }
  }

 private:
  void add_contact(SignedDistance obstacle, double stiffness, double friction) {
    ContactOptions options;
    options.stiffness = stiffness;
    options.friction = friction;
    forces.push_back(std::make_shared<Contact>(body, std::move(obstacle), options));
  }
};

/// A body and how it stands.
class Motion {
 public:
  Motion(const Loads& loads, double step, const std::string& time_scheme)
      : Motion(ElasticMotion(loads.body, loads.forces, loads.supports, options_of(step, time_scheme)),
               state_at_rest(loads.body)) {}
  Motion(ElasticMotion motion, ElasticState state) : motion_(std::move(motion)), state_(std::move(state)) {}

  void step(int count, const py::object& progress) {
    run(progress, [&](const Progress& report) {
      for (int i = 0; i < count; ++i)
        motion_.step(state_, progress_within(report, i / double(count), (i + 1.0) / count));
      return 0;
    });
  }
  py::dict find_equilibrium(const py::object& progress) {
    const EquilibriumReport report =
        run(progress, [&](const Progress& of_call) { return motion_.find_equilibrium(state_, {}, of_call); });
    py::dict result;
    result["rounds"] = report.rounds;
    result["change"] = report.change;
    result["residual_force"] = report.residual_force;
    result["converged"] = report.converged;
    return result;
  }
  Motion refined(const py::object& progress) const {
    ElasticMotion finer = run(progress, [&](const Progress& report) { return motion_.refined(state_, report); });
    return {std::move(finer), refined_state(motion_.surface(), state_)};
  }
  py::dict measure() const {
    const MotionMeasure measure = motion_.measure(state_);
    py::dict result;
    result["kinetic_energy"] = measure.kinetic_energy;
    result["elastic_energy"] = measure.elastic_energy;
    result["force_energy"] = measure.force_energy;
    result["residual_force"] = measure.residual_force;
    return result;
  }
  double time() const { return state_.time; }
  py::array_t<double> positions() const { return array_of(Points(state_.positions)); }
  py::array_t<double> velocities() const { return array_of(Points(state_.velocities)); }
  void set(double time, const Doubles& positions, const Doubles& velocities) {
    const Eigen::Map<const Values> at = points_of(positions, "positions");
    const Eigen::Map<const Values> moving = points_of(velocities, "velocities");
    if (at.rows() != state_.positions.rows() || moving.rows() != at.rows()) {
      throw Error(ErrorCode::BadShape, "the body has " + std::to_string(state_.positions.rows()) + " control points");
    }
    state_ = {time, at, moving};
  }
  Mesh mesh() const {
    Mesh mesh = mesh_from_topology(motion_.surface().topology());
    mesh.points = state_.positions;
    return mesh;
  }

 private:
  static MotionOptions options_of(double step, const std::string& time_scheme) {
    MotionOptions options;
    options.step = step;
    options.scheme = choice_of(time_scheme, kTimeSchemes, "the time scheme");
    return options;
  }

  ElasticMotion motion_;
  ElasticState state_;
};

}  // namespace

void bind_elastic(py::module_& module) {
  py::class_<SurfaceEnergy>(module, "SurfaceEnergy")
      .def(py::init([](const Topology& topology, const Scheme& scheme, const std::vector<double>& density,
                       const std::vector<double>& tension, const std::vector<double>& rigidity,
                       const py::object& progress) {
        const EnergyOptions options{density, tension, rigidity, {}};
        return run(progress, [&](const Progress& report) { return SurfaceEnergy(topology, scheme, options, report); });
      }))
      .def("matrix",
           [](const SurfaceEnergy& energy, const std::string& kind, const py::object& progress) {
             const EnergyKind which = choice_of(kind, kEnergies, "the energy");
             return sparse_of(run(progress, [&](const Progress& report) { return energy.matrix(which, report); }));
           })
      .def("energy", [](const SurfaceEnergy& energy, const std::string& kind, const Doubles& control) {
        return energy.energy(choice_of(kind, kEnergies, "the energy"), rows_of(control));
      });
  py::class_<ElasticSurface>(module, "ElasticSurface")
      .def(py::init([](const Topology& topology, const Scheme& scheme, const Doubles& rest,
                       const std::vector<double>& density, const std::vector<double>& damping,
                       const std::vector<double>& tension, const std::vector<double>& rigidity,
                       const std::string& rest_model, const py::object& progress) {
        return make_body(topology, scheme, rest, {density, damping, tension, rigidity}, rest_model, progress);
      }))
      .def("mass", [](const ElasticSurface& body) { return sparse_of(body.mass()); })
      .def("damping", [](const ElasticSurface& body) { return sparse_of(body.damping()); })
      .def("stiffness", [](const ElasticSurface& body) { return sparse_of(body.stiffness()); })
      .def("energy", [](const ElasticSurface& body, const Doubles& at) { return body.energy(points_of(at)); })
      .def("force", [](const ElasticSurface& body, const Doubles& at) { return array_of(body.force(points_of(at))); });
  py::class_<Loads>(module, "Loads")
      .def(py::init<const ElasticSurface&>())
      .def("add_springs", &Loads::add_springs)
      .def("add_gravity", &Loads::add_gravity)
      .def("add_pressure", &Loads::add_pressure)
      .def("add_volume", &Loads::add_volume)
      .def("add_wind", &Loads::add_wind)
      .def("add_plane", &Loads::add_plane)
      .def("add_sphere", &Loads::add_sphere)
      .def("hold", &Loads::hold)
      .def("pin", &Loads::pin);
  py::class_<Motion>(module, "Motion")
      .def(py::init<const Loads&, double, const std::string&>())
      .def("step", &Motion::step)
      .def("find_equilibrium", &Motion::find_equilibrium)
      .def("refined", &Motion::refined)
      .def("measure", &Motion::measure)
      .def("time", &Motion::time)
      .def("positions", &Motion::positions)
      .def("velocities", &Motion::velocities)
      .def("set", &Motion::set)
      .def("mesh", &Motion::mesh);
}

}  // namespace batten::python
