#include "batten/dynamics/elastic_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "batten/dynamics/nearest_springs.h"
#include "batten/dynamics/scene_parts.h"
#include "batten/dynamics/spring.h"
#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/mesh/moved_mesh.h"
#include "batten/mixed_bits.h"
#include "batten/refine/refined_mesh.h"
#include "batten/refine/refinement.h"

namespace batten {

SceneMeshes read_scene_meshes(const ElasticScene& scene, const Progress& progress, std::vector<std::string>* notes) {
  SceneMeshes meshes;
  const auto read = [&](const std::string& place, const std::string& path) {
    return dynamics::made_at(scene, place, [&] { return read_mesh(path, "", progress, notes); });
  };
  meshes.rest = read("mesh", scene.mesh);
  if (!scene.start.empty()) meshes.start = read("start.mesh", scene.start);
  for (std::size_t i = 0; i < scene.forces.size(); ++i) {
    const auto* springs = std::get_if<SceneNearestSprings>(&scene.forces[i]);
    if (springs == nullptr || springs->file.empty()) continue;
    meshes.clouds.push_back(read("forces[" + std::to_string(i) + "].points", springs->file).points);
  }
  return meshes;
}

namespace {

/// What each number adds depends on all before it.
class Checksum {
 public:
  void add(std::uint64_t bits) { sum_ = mixed_bits(sum_ + bits + 0x9e3779b97f4a7c15U); }
  void add(double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof(bits));
    add(bits);
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

std::uint64_t body_checksum(const Topology& topology, const Points& rest) {
  Checksum sum;
  for (Index h = 0; h < topology.half_edge_count(); ++h) sum.add(static_cast<std::uint64_t>(topology.origin(h)));
  for (Index f = 0; f < topology.face_count(); ++f) sum.add(static_cast<std::uint64_t>(topology.face_size(f)));
  for (Eigen::Index i = 0; i < rest.size(); ++i) sum.add(rest.data()[i]);
  return sum.sum();
}

/// Steps end a little beside whole multiples of their length.
constexpr double kTimeShare = 1e-6;

}  // namespace

struct ElasticRun::Parts {
  ElasticScene scene;
  Scheme scheme;
  Mesh mesh;                         ///< of now: tags and attributes; the points are those of the rest shape
  std::vector<Topology> topologies;  ///< of all control meshes so far
  ElasticMotion motion;
  ElasticRunState run;

  void refine(const Progress& progress);
  bool refinement_is_due() const;
  bool is_at_rest(const ElasticRow& row) const;
};

void ElasticRun::Parts::refine(const Progress& progress) {
  const ElasticState before = run.state;
  RefinedMesh refined = refine_mesh(topologies.back(), scheme, mesh, 1, progress);
  ElasticMotion finer = motion.refined(before, progress);
  run.state = refined_state(motion.surface(), before);
  motion = std::move(finer);
  mesh = std::move(refined.mesh);
  topologies.push_back(motion.surface().topology());
  run.refined_at.push_back(before);
  run.at_rest = false;
}

bool ElasticRun::Parts::refinement_is_due() const {
  const SceneTime& time = scene.time;
  const std::size_t done = run.refined_at.size();
  if (done < time.refine_at.size()) return run.state.time >= time.refine_at[done] - kTimeShare * time.motion.step;
  return run.at_rest && done < time.refine_at.size() + static_cast<std::size_t>(time.refine_at_rest);
}

bool ElasticRun::Parts::is_at_rest(const ElasticRow& row) const {
  constexpr double kSpeed = 1e-3;
  constexpr double kAcceleration = 1e-2;
  const ElasticSurface& body = motion.surface();
  const double share = body.diagonal() / body.topology().vertex_count();
  const double speed = scene.time.rest.speed.value_or(kSpeed * body.diagonal());
  const double mass = body.mass().sum();
  const double damping = body.damping_ratio() ? *body.damping_ratio() * mass : body.damping().sum();
  const double usual_force = share * (kAcceleration * mass + kSpeed * damping);
  return row.speed <= speed && row.measure.residual_force <= scene.time.rest.force.value_or(usual_force);
}

ElasticRun::ElasticRun(const ElasticScene& scene, const SceneMeshes& meshes, const Progress& progress) {
  if (const std::string wrong = dynamics::wrong_steps(scene.time); !wrong.empty())
    throw Error(ErrorCode::BadArgument, scene.name + ": time: " + wrong);
  dynamics::SceneBody parts = dynamics::scene_body(scene, meshes, progress);
  const ElasticSurface body = dynamics::made_at(scene, "material", [&] {
    return ElasticSurface(parts.topology, parts.scheme, parts.mesh.points, dynamics::body_options(scene, meshes),
                          progress);
  });
  Supports supports = dynamics::scene_supports(scene, body, parts.start);
  ElasticMotion motion = dynamics::made_at(scene, "time", [&] {
    return ElasticMotion(body, dynamics::scene_forces(scene, meshes, body), std::move(supports), scene.time.motion);
  });
  ElasticRunState run;
  run.state.positions = parts.start;
  run.state.velocities = Points::Zero(parts.start.rows(), 3).rowwise() + scene.velocity.transpose();
  run.body = body_checksum(parts.topology, parts.mesh.points);
  parts_ = std::make_unique<Parts>(
      Parts{scene, parts.scheme, std::move(parts.mesh), {parts.topology}, std::move(motion), std::move(run)});
}

ElasticRun::~ElasticRun() = default;
ElasticRun::ElasticRun(ElasticRun&&) noexcept = default;
ElasticRun& ElasticRun::operator=(ElasticRun&&) noexcept = default;

const ElasticScene& ElasticRun::scene() const { return parts_->scene; }
const ElasticMotion& ElasticRun::motion() const { return parts_->motion; }
const ElasticState& ElasticRun::state() const { return parts_->run.state; }
const Scheme& ElasticRun::scheme() const { return parts_->scheme; }
Index ElasticRun::refined() const { return static_cast<Index>(parts_->run.refined_at.size()); }
bool ElasticRun::at_rest() const { return parts_->run.at_rest; }

bool ElasticRun::done() const {
  const SceneTime& time = parts_->scene.time;
  if (parts_->run.at_rest && time.until_rest && !parts_->refinement_is_due()) return true;
  return parts_->run.state.time >= time.seconds - kTimeShare * time.motion.step;
}

Index ElasticRun::frame() const {
  const SceneTime& time = parts_->scene.time;
  const double frames = parts_->scene.output.frames_per_second;
  const double number = std::floor((parts_->run.state.time + kTimeShare * time.motion.step) * frames);
  return static_cast<Index>(std::min(number, double{std::numeric_limits<Index>::max()}));
}

Mesh ElasticRun::mesh() const { return with_points(parts_->mesh, parts_->run.state.positions); }

Points ElasticRun::refined_points(ConstValuesRef points, Index refined) const {
  if (refined < 0 || refined > this->refined()) {
    throw Error(ErrorCode::BadShape,
                "the mesh is refined " + std::to_string(this->refined()) + " times, not " + std::to_string(refined));
  }
  const auto levels = this->refined() - refined;
  return batten::refine(parts_->topologies[static_cast<std::size_t>(refined)], parts_->scheme, points, levels).values;
}

Points ElasticRun::spring_lines(const Points& positions, double time) const {
  std::vector<Eigen::Vector3d> ends;
  for (const auto& force : motion().forces()) {
    if (const auto* springs = dynamic_cast<const PointSprings*>(force.get())) {
      std::vector<SurfacePlace> places;
      for (const PointSprings::Spring& spring : springs->springs()) places.push_back(spring.place);
      const Points points = place_rows(motion().surface().patches(), places).rows * positions;
      for (std::size_t i = 0; i < places.size(); ++i) {
        ends.emplace_back(points.row(static_cast<Eigen::Index>(i)).transpose());
        ends.push_back(springs->springs()[i].target(time));
      }
    } else if (const auto* nearest = dynamic_cast<const NearestSprings*>(force.get())) {
      const std::vector<NearestPoint>& attached = nearest->attach(positions);
      for (std::size_t i = 0; i < attached.size(); ++i) {
        ends.push_back(attached[i].point);
        ends.emplace_back(nearest->points().row(static_cast<Eigen::Index>(i)).transpose());
      }
    }
  }
  Points lines(static_cast<Eigen::Index>(ends.size()), 3);
  for (Eigen::Index i = 0; i < lines.rows(); ++i) lines.row(i) = ends[static_cast<std::size_t>(i)].transpose();
  return lines;
}

ElasticRow ElasticRun::step(const Progress& progress) {
  Parts& parts = *parts_;
  if (parts.refinement_is_due()) parts.refine(progress);
  const SceneTime& time = parts.scene.time;
  const ElasticState& before = parts.run.state;
  ElasticState state = before;
  ElasticRow row;
  row.step = time.step_error ? parts.motion.advance(state, time.motion.step, *time.step_error, progress)
                             : parts.motion.step(state, progress);
  row.time = state.time;
  row.measure = parts.motion.measure(state);
  row.vertices = static_cast<Index>(state.positions.rows());
  row.speed = (state.positions - before.positions).norm() / std::sqrt(static_cast<double>(row.vertices)) /
              (state.time - before.time);
  parts.run.state = std::move(state);
  row.at_rest = parts.is_at_rest(row);
  parts.run.at_rest = row.at_rest;
  return row;
}

EquilibriumReport ElasticRun::find_equilibrium(const Progress& progress) {
  ElasticState state = parts_->run.state;
  const EquilibriumReport report = parts_->motion.find_equilibrium(state, {}, progress);
  parts_->run.state = std::move(state);
  parts_->run.at_rest = report.converged;
  return report;
}

ElasticRunState ElasticRun::save() const { return parts_->run; }

void ElasticRun::resume(const ElasticRunState& saved, const Progress& progress) {
  Parts& parts = *parts_;
  const std::string from = parts.scene.name + ": the state to go on from ";
  if (saved.body != parts.run.body) {
    throw Error(ErrorCode::BadArgument, from + "is of another body; it goes with the mesh that it was written for");
  }
  if (!parts.run.refined_at.empty()) throw Error(ErrorCode::BadArgument, "a run that was refined cannot go back");
  for (const ElasticState& before : saved.refined_at) {
    parts.run.state = before;
    parts.refine(progress);
  }
  if (saved.state.positions.rows() != parts.run.state.positions.rows()) {
    throw Error(ErrorCode::BadArgument, from + "has " + std::to_string(saved.state.positions.rows()) +
                                            " control points, and the body " +
                                            std::to_string(parts.run.state.positions.rows()));
  }
  parts.run = saved;
}

}  // namespace batten
