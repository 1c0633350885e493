#include "batten/render/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten::render_detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kFieldOfView = 30.0 * kRadians;
constexpr double kFill = 0.85;
constexpr float kMargin = 1e-3F;

/// Calls visit(point) for what the frame was made of, at most about `limit` points of each kind.
template <typename Visit>
void visit_points(const Scene& scene, std::size_t limit, const Visit& visit) {
  for (const Mesh* mesh : {&scene.surface, &scene.lines}) {
    const std::size_t corners = mesh->face_vertices.size();
    const std::size_t stride = corners / limit + 1;
    for (std::size_t c = 0; c < corners; c += stride) visit(mesh->points.row(mesh->face_vertices[c]));
  }
  const auto markers = static_cast<std::size_t>(scene.markers.rows());
  const std::size_t stride = markers / limit + 1;
  for (std::size_t m = 0; m < markers; m += stride) visit(scene.markers.row(static_cast<Eigen::Index>(m)));
}

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Counter-clockwise, by Andrew's monotone chain.
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t floor = hull.size() + 1;
    for (const Vector2d& point : points) {
      while (hull.size() > floor && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += turn(Vector2d::Zero(), polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

bool contains(const std::vector<Vector2d>& hull, const Vector2d& point) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (turn(hull[i], hull[(i + 1) % hull.size()], point) < 0.0) return false;
  }
  return hull.size() > 2;
}

/// The share of the floor plan that the shape's foot takes, or 0 where the shape would topple.
double steadiness(const std::vector<Vector3d>& points, int axis) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  Vector2d centre = Vector2d::Zero();
  std::vector<Vector2d> plan;
  for (const Vector3d& point : points) {
    lowest = std::min(lowest, point[axis]);
    highest = std::max(highest, point[axis]);
    plan.emplace_back(point[(axis + 1) % 3], point[(axis + 2) % 3]);
    centre += plan.back() / static_cast<double>(points.size());
  }
  std::vector<Vector2d> foot;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][axis] <= lowest + 0.03 * (highest - lowest)) foot.push_back(plan[i]);
  }
  const std::vector<Vector2d> base = convex_hull(std::move(foot));
  const double whole = area(convex_hull(std::move(plan)));
  return whole > 0.0 && contains(base, centre) ? area(base) / whole : 0.0;
}

/// Directions of the shape's own right, back and up; the eye stands in front, where `back` points away from it.
struct Axes {
  Vector3d right;
  Vector3d back;
  Vector3d up;
};

Axes axes_of(UpAxis up) {
  if (up == UpAxis::Y) return {Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d::UnitY()};
  return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

Vector3d default_view(const Frame& frame, const Axes& axes) {
  const Vector3d size = (frame.highest - frame.lowest).transpose() * frame.scale;
  const double width = std::abs(size.dot(axes.right));
  const double depth = std::abs(size.dot(axes.back));
  const double height = std::abs(size.dot(axes.up));
  const double azimuth = std::clamp(35.0 + 20.0 * std::log2((depth + 0.05) / (width + 0.05)), 25.0, 60.0) * kRadians;
  const double flatness = 1.0 - std::min(1.0, 2.0 * height / std::hypot(width, depth));
  const double elevation = (20.0 + 20.0 * flatness) * kRadians;
  return std::cos(elevation) * (std::sin(azimuth) * axes.right - std::cos(azimuth) * axes.back) +
         std::sin(elevation) * axes.up;
}

/// The eye that sees every point within the tangents, as near as can be: each side of the frustum touches a point, or
/// the two sides of the tighter direction do and the other direction is centred.
Vector3d fitted_eye(const Scene& scene, const Frame& frame, const Eigen::Matrix3d& to_view, double tangent_x,
                    double tangent_y) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  Eigen::Array4d reach = Eigen::Array4d::Constant(kNone);  // right, left, top, bottom
  visit_points(scene, std::size_t{1} << 21, [&](const Eigen::RowVector3d& point) {
    const Vector3d at = to_view * ((point - frame.centre) * frame.scale).transpose();
    reach = reach.max(Eigen::Array4d(at.x() + tangent_x * at.z(), -at.x() + tangent_x * at.z(),
                                     at.y() + tangent_y * at.z(), -at.y() + tangent_y * at.z()));
  });
  const double distance =
      std::max((reach[0] + reach[1]) / (2.0 * tangent_x), (reach[2] + reach[3]) / (2.0 * tangent_y));
  // A single point gives no distance of its own.
  const Vector3d eye(0.5 * (reach[0] - reach[1]), 0.5 * (reach[2] - reach[3]), std::max(distance, 0.1));
  return to_view.transpose() * eye;
}

}  // namespace

UpAxis resolve_up(const Scene& scene, const Frame& frame, UpAxis asked) {
  if (asked != UpAxis::Auto) return asked;
  std::vector<Vector3d> points;
  visit_points(scene, 50000, [&](const Eigen::RowVector3d& point) {
    points.emplace_back(((point - frame.centre) * frame.scale).transpose());
  });
  const double on_y = steadiness(points, 1);
  const double on_z = steadiness(points, 2);
  constexpr double kTopples = 0.03;
  if (on_y < kTopples && on_z < kTopples) return UpAxis::Y;
  return on_y > 1.2 * on_z ? UpAxis::Y : UpAxis::Z;
}

Camera camera_of(const Scene& scene, const Frame& frame, const RenderOptions& options) {
  const Axes axes = axes_of(resolve_up(scene, frame, options.up));
  Vector3d view = default_view(frame, axes);
  if (options.view) {
    view = Vector3d((*options.view)[0], (*options.view)[1], (*options.view)[2]);
    if (!view.allFinite() || view.stableNorm() == 0.0)
      throw Error(ErrorCode::BadArgument, "the view must be a finite direction other than zero");
    view.stableNormalize();
  }
  // Seen from straight above or below, the shape's back is at the top of the picture.
  const bool vertical = view.cross(axes.up).norm() < 1e-6;
  const Vector3d hint = vertical ? Vector3d(axes.back * (view.dot(axes.up) > 0.0 ? 1.0 : -1.0)) : axes.up;
  Eigen::Matrix3d to_view;
  to_view.row(2) = view.transpose();
  to_view.row(0) = hint.cross(view).normalized().transpose();
  to_view.row(1) = view.transpose().cross(to_view.row(0));

  const double tangent_y = std::tan(0.5 * kFieldOfView);
  const double tangent_x = tangent_y * options.width / options.height;
  Camera camera;
  camera.eye = fitted_eye(scene, frame, to_view, kFill * tangent_x, kFill * tangent_y).cast<float>();
  camera.right = to_view.row(0).transpose().cast<float>();
  camera.up = to_view.row(1).transpose().cast<float>();
  camera.forward = -view.cast<float>();
  camera.tangent_x = static_cast<float>(tangent_x);
  camera.tangent_y = static_cast<float>(tangent_y);
  camera.world_up = axes.up.cast<float>();
  // A hair below the shape, so that a flat sheet lies on the ground rather than in it.
  camera.ground_height =
      static_cast<float>(((frame.lowest - frame.centre) * frame.scale).dot(axes.up.transpose())) - kMargin;
  return camera;
}

}  // namespace batten::render_detail
