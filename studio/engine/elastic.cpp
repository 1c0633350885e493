#include "studio/engine/elastic.h"

#include "batten/dynamics/contact.h"
#include "batten/dynamics/gravity.h"
#include "batten/dynamics/pressure.h"
#include "batten/dynamics/spring.h"
#include "batten/mesh/topology.h"
#include "batten/mesh/up_axis.h"
#include "batten/nearest/nearest_point.h"
#include "batten/refine/refined_mesh.h"

namespace batten::studio {
namespace {

constexpr double kFloorGap = 0.15;  ///< of the body's size, from its foot to the floor

bool has_boundary(const Topology& topology) {
  for (Index edge = 0; edge < topology.edge_count(); ++edge)
    if (topology.is_boundary_edge(edge)) return true;
  return false;
}

/// Holds a closed body, which nothing else holds, by springs at the middle of some faces, as on a bed of foam.
std::shared_ptr<const Force> soft_hold(const ElasticSurface& body) {
  constexpr Index kSprings = 64;
  constexpr double kStiffness = 1500.0;
  const LimitSurface surface(body.patches(), body.rest());
  const Index faces = surface.base().face_count();
  const Index stride = std::max<Index>(1, faces / kSprings);
  const double middle = body.patches().quads() ? 0.5 : 1.0 / 3.0;
  std::vector<PointSprings::Spring> springs;
  for (Index face = 0; face < faces; face += stride) {
    const SurfacePlace place{face, middle, middle};
    springs.push_back({place, stay_at(surface.jet(place).point), 0.0});
  }
  for (PointSprings::Spring& spring : springs) spring.stiffness = kStiffness / static_cast<double>(springs.size());
  return std::make_shared<PointSprings>(body, std::move(springs));
}

}  // namespace

Elastic::Elastic(const std::shared_ptr<const MeshFile>& file, const Scheme& scheme, const ElasticWishes& wishes)
    : mesh_(file->mesh()), up_(file->up()), topology_(mesh_), scheme_(scheme), wishes_(wishes) {
  const Points& points = mesh_.points;
  const double diagonal = bounding_diagonal(points);
  if (!(diagonal > 0.0)) throw Error(ErrorCode::BadArgument, "all points are at one place: there is no body");
  scale_ = diagonal;
  centre_ = points.colwise().mean();
  const Points rest = (points.rowwise() - centre_) / scale_;
  ElasticOptions options;
  options.material = {{1.0}, {wishes.damping}, {wishes.tension}, {wishes.rigidity}};
  body_.emplace(topology_, scheme_, rest, options);
  if (wishes.pressure != 0.0) lasting_.push_back(std::make_shared<Pressure>(*body_, wishes.pressure));
  const Eigen::Vector3d up = up_frame(up_).up;
  if (wishes.gravity != 0.0)
    lasting_.push_back(std::make_shared<Gravity>(*body_, Eigen::Vector3d(-wishes.gravity * up)));
  if (wishes.floor) {
    const Eigen::Vector3d foot = ((rest * up).minCoeff() - kFloorGap) * up;
    lasting_.push_back(std::make_shared<Contact>(*body_, plane_obstacle(foot, up)));
  }
  if (wishes.hold_boundary && has_boundary(topology_)) {
    supports_ = hold_boundary(*body_);
  } else if (!wishes.floor) {
    lasting_.push_back(soft_hold(*body_));
  }
  state_ = state_at_rest(*body_);
  rebuild();
}

void Elastic::rebuild() {
  std::vector<std::shared_ptr<const Force>> forces = lasting_;
  if (spring_) forces.push_back(spring_);
  motion_.emplace(*body_, std::move(forces), supports_);
}

Eigen::Vector3d Elastic::inward(double x, double y, double z) const {
  return (Eigen::Vector3d(x, y, z) - centre_.transpose()) / scale_;
}

val Elastic::grab(double x, double y, double z, double stiffness) {
  return guarded([&] {
    const NearestPoints nearest(body_->patches(), state_.positions);
    const NearestPoint found = nearest.nearest(inward(x, y, z));
    hand_ = std::make_shared<Eigen::Vector3d>(found.point);
    const PointPath path = [hand = hand_](double) { return *hand; };
    spring_ = std::make_shared<PointSprings>(*body_, std::vector<PointSprings::Spring>{{found.place, path, stiffness}});
    rebuild();
    return val::null();
  });
}

val Elastic::pull(double x, double y, double z) {
  return guarded([&] {
    if (hand_) *hand_ = inward(x, y, z);
    return val::null();
  });
}

val Elastic::release() {
  return guarded([&] {
    hand_.reset();
    spring_.reset();
    rebuild();
    return val::null();
  });
}

val Elastic::step(int count) {
  return guarded([&] {
    for (int i = 0; i < count; ++i) motion_->step(state_);
    val result = val::object();
    result.set("time", state_.time);
    return result;
  });
}

val Elastic::pin(double x, double y, double z) {
  return guarded([&] {
    const NearestPoints nearest(body_->patches(), state_.positions);
    const NearestPoint found = nearest.nearest(inward(x, y, z));
    supports_.pins.push_back({found.place, stay_at(found.point)});
    rebuild();
    const Eigen::Vector3d point = found.point * scale_ + centre_.transpose();
    val result = val::object();
    result.set("point", typed_array(point.data(), 3));
    return result;
  });
}

val Elastic::refine() {
  return guarded([&] {
    const ElasticSurface child = body_->refined();
    for (std::shared_ptr<const Force>& force : lasting_) force = force->refined(*body_, child);
    if (spring_) spring_ = spring_->refined(*body_, child);
    supports_ = refined_supports(*body_, supports_, state_);
    mesh_ = refine_mesh(topology_, scheme_, mesh_, 1).mesh;
    state_ = refined_state(*body_, state_);
    topology_ = child.topology();
    scheme_ = child.patches().scheme();
    body_.emplace(child);
    rebuild();
    return val::null();
  });
}

Points Elastic::control_points() const { return (state_.positions * scale_).rowwise() + centre_; }

val Elastic::control() const {
  return guarded([&] { return typed_array(control_points()); });
}

val Elastic::control_file() const {
  return guarded([&] {
    Mesh mesh = mesh_;
    mesh.points = control_points();
    state_scheme(scheme_, mesh);
    return val(std::make_shared<MeshFile>(std::move(mesh), up_));
  });
}

val make_elastic(const std::shared_ptr<MeshFile>& file, const val& wishes) {
  return guarded([&] {
    Scheme scheme;
    scheme.kind = static_cast<SchemeKind>(wishes["scheme"].as<int>());
    scheme.boundary = static_cast<BoundaryRule>(wishes["boundary"].as<int>());
    ElasticWishes asked;
    asked.tension = wishes["tension"].as<double>();
    asked.rigidity = wishes["rigidity"].as<double>();
    asked.damping = wishes["damping"].as<double>();
    asked.pressure = wishes["pressure"].as<double>();
    asked.gravity = wishes["gravity"].as<double>();
    asked.floor = wishes["floor"].as<bool>();
    asked.hold_boundary = wishes["holdBoundary"].as<bool>();
    return val(std::make_shared<Elastic>(file, scheme, asked));
  });
}

}  // namespace batten::studio
