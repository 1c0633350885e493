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

/// Calls visit(point) for the points that the frame encloses, at most about `limit` of each kind.
template <typename Visit>
void visit_points(const Scenes& scenes, std::size_t limit, const Visit& visit) {
  for (const Scene* scene : scenes) {
    for (const Mesh* mesh : {&scene->surface, &scene->lines}) {
      const std::size_t corners = mesh->face_vertices.size();
      const std::size_t stride = corners / limit + 1;
      for (std::size_t c = 0; c < corners; c += stride) visit(mesh->points.row(mesh->face_vertices[c]));
    }
    const auto markers = static_cast<std::size_t>(scene->markers.rows());
    const std::size_t stride = markers / limit + 1;
    for (std::size_t m = 0; m < markers; m += stride) visit(scene->markers.row(static_cast<Eigen::Index>(m)));
  }
}

Vector3d default_view(const Frame& frame, const UpFrame& axes) {
  const Vector3d size = (frame.highest - frame.lowest).transpose() * frame.scale;
  const double width = std::abs(size.dot(axes.right));
  const double depth = std::abs(size.dot(axes.back));
  const double height = std::abs(size.dot(axes.up));
  const double azimuth = std::clamp(35.0 + 20.0 * std::log2((depth + 0.05) / (width + 0.05)), 25.0, 40.0) * kRadians;
  const double flatness = 1.0 - std::min(1.0, 2.0 * height / std::hypot(width, depth));
  const double elevation = (20.0 + 20.0 * flatness) * kRadians;
  return std::cos(elevation) * (std::sin(azimuth) * axes.right - std::cos(azimuth) * axes.back) +
         std::sin(elevation) * axes.up;
}

Vector3d named_view(View view, const Scenes& scenes, const Frame& frame, const UpFrame& axes) {
  switch (view) {
    case View::Front:
      return -axes.back;
    case View::Back:
      return axes.back;
    case View::Left:
      return -axes.right;
    case View::Right:
      return axes.right;
    case View::Top:
      return axes.up;
    case View::Bottom:
      return -axes.up;
    case View::Iso:
      return (axes.right - axes.back + axes.up).normalized();
    case View::Auto:
      break;
  }
  const Vector3d normal = flat_normal(scenes, frame);
  return normal.isZero(0.0) ? default_view(frame, axes) : normal;
}

Vector3d asked_view(const RenderOptions& options, const Scenes& scenes, const Frame& frame, const UpFrame& axes) {
  if (!options.direction) return named_view(options.view, scenes, frame, axes);
  const Vector3d view((*options.direction)[0], (*options.direction)[1], (*options.direction)[2]);
  if (!view.allFinite() || view.stableNorm() == 0.0)
    throw Error(ErrorCode::BadArgument, "the view must be a finite direction other than zero");
  return view.stableNormalized();
}

/// The rows are the picture's right and up, and the direction to the eye.
Eigen::Matrix3d view_axes(const Vector3d& view, const UpFrame& axes) {
  // Seen from straight above or below, the shape's back is at the top of the picture.
  const bool vertical = view.cross(axes.up).norm() < 1e-6;
  const Vector3d hint = vertical ? Vector3d(axes.back * (view.dot(axes.up) > 0.0 ? 1.0 : -1.0)) : axes.up;
  Eigen::Matrix3d to_view;
  to_view.row(2) = view.transpose();
  to_view.row(0) = hint.cross(view).normalized().transpose();
  to_view.row(1) = view.transpose().cross(to_view.row(0));
  return to_view;
}

/// How far the shape extends towards the frustum's four sides: right, left, top, bottom.
Eigen::Array4d reach_of(const Scenes& scenes, const Frame& frame, const Eigen::Matrix3d& to_view,
                        const Vector2d& tangents) {
  Eigen::Array4d reach = Eigen::Array4d::Constant(-std::numeric_limits<double>::infinity());
  visit_points(scenes, std::size_t{1} << 21, [&](const Eigen::RowVector3d& point) {
    const Vector3d at = to_view * ((point - frame.centre) * frame.scale).transpose();
    reach = reach.max(Eigen::Array4d(at.x() + tangents.x() * at.z(), -at.x() + tangents.x() * at.z(),
                                     at.y() + tangents.y() * at.z(), -at.y() + tangents.y() * at.z()));
  });
  return reach;
}

Vector2d tangents_of(const RenderOptions& options) {
  const double tangent = std::tan(0.5 * kFieldOfView);
  return {tangent * options.width / options.height, tangent};
}

std::array<double, 3> to_array(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

constexpr double kNearest = 0.1;  // for a single point, which determines no distance

}  // namespace

UpAxis resolve_up(const Scenes& scenes, UpAxis asked) {
  if (asked != UpAxis::Auto) return asked;
  const Scene& first = *scenes.front();
  if (first.surface.face_count() > 0) return guess_up_axis(first.surface);
  if (first.lines.face_count() > 0) return guess_up_axis(first.lines);
  Mesh points;
  points.points = first.markers;
  return guess_up_axis(points);
}

Vector3d flat_normal(const Scenes& scenes, const Frame& frame) {
  constexpr double kFlat = 1.0 / 500.0;  // the frame's diagonal is 2
  Vector3d normal = Vector3d::Zero();
  for (const Scene* scene : scenes) {
    const Mesh& mesh = scene->surface;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Index* v = mesh.face_vertices.data() + mesh.face_offsets[f];
      const Vector3d first = ((mesh.points.row(v[0]) - frame.centre) * frame.scale).transpose();
      for (Index c = 1; c + 1 < mesh.face_size(f); ++c) {
        const Vector3d a = ((mesh.points.row(v[c]) - frame.centre) * frame.scale).transpose() - first;
        const Vector3d b = ((mesh.points.row(v[c + 1]) - frame.centre) * frame.scale).transpose() - first;
        normal += a.cross(b);
      }
    }
  }
  if (!(normal.norm() > 1e-6)) return Vector3d::Zero();  // a closed mesh: the sides cancel
  normal.normalize();
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  visit_points(scenes, std::size_t{1} << 21, [&](const Eigen::RowVector3d& point) {
    const double height = ((point - frame.centre) * frame.scale).dot(normal.transpose());
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  });
  return highest - lowest <= 2.0 * kFlat ? normal : Vector3d(Vector3d::Zero());
}

/// The closest viewpoint at which everything fits: each side of the frustum touches a point, or the two sides of the
/// tighter direction do and the other direction is centred.
Viewpoint fitted_viewpoint(const Scenes& scenes, const RenderOptions& options) {
  const Frame frame = frame_of(scenes);
  const UpAxis up = resolve_up(scenes, options.up);
  const UpFrame axes = up_frame(up);
  const Vector3d view = asked_view(options, scenes, frame, axes);
  const Eigen::Matrix3d to_view = view_axes(view, axes);
  const Vector2d tangents = kFill * tangents_of(options);
  const Eigen::Array4d reach = reach_of(scenes, frame, to_view, tangents);
  const double distance =
      std::max({(reach[0] + reach[1]) / (2.0 * tangents.x()), (reach[2] + reach[3]) / (2.0 * tangents.y()), kNearest});
  const Vector3d target = to_view.transpose() * Vector3d(0.5 * (reach[0] - reach[1]), 0.5 * (reach[2] - reach[3]), 0.0);
  return {to_array(frame.centre.transpose() + target / frame.scale), to_array(view), distance / frame.scale, up};
}

std::vector<Viewpoint> turned_viewpoints(const Scenes& scenes, const RenderOptions& options, int count) {
  if (count < 1) throw Error(ErrorCode::BadArgument, "a turntable needs at least one picture");
  const Frame frame = frame_of(scenes);
  const UpAxis up = resolve_up(scenes, options.up);
  const UpFrame axes = up_frame(up);
  Vector3d first = asked_view(options, scenes, frame, axes);
  if (options.view == View::Auto && !options.direction && first.cross(axes.up).norm() < 1e-3)
    first = default_view(frame, axes);  // a flat mesh that lies on the ground
  if (first.cross(axes.up).norm() < 1e-3)
    throw Error(ErrorCode::BadArgument, "a turntable needs a view from the side, not from straight above or below");
  const Vector2d tangents = kFill * tangents_of(options);
  double distance = kNearest;
  std::vector<Viewpoint> viewpoints;
  for (int i = 0; i < count; ++i) {
    const Vector3d view = Eigen::AngleAxisd(360.0 * kRadians * i / count, axes.up) * first;
    const Eigen::Array4d reach = reach_of(scenes, frame, view_axes(view, axes), tangents);
    distance =
        std::max({distance, reach.head<2>().maxCoeff() / tangents.x(), reach.tail<2>().maxCoeff() / tangents.y()});
    viewpoints.push_back({to_array(frame.centre.transpose()), to_array(view), 0.0, up});
  }
  for (Viewpoint& viewpoint : viewpoints) viewpoint.distance = distance / frame.scale;
  return viewpoints;
}

Camera camera_of(const Scene& scene, const Frame& frame, const RenderOptions& options) {
  const Viewpoint viewpoint = options.viewpoint ? *options.viewpoint : fitted_viewpoint({&scene}, options);
  const UpFrame axes = up_frame(viewpoint.up);
  const Vector3d view = to_vector(viewpoint.direction).stableNormalized();
  const Vector3d eye = to_vector(viewpoint.target) - frame.centre.transpose() + viewpoint.distance * view;
  if (!view.allFinite() || view.isZero() || !eye.allFinite() || !(viewpoint.distance > 0.0))
    throw Error(ErrorCode::BadArgument,
                "the viewpoint must be finite, its direction other than zero, its distance positive");
  const Eigen::Matrix3d to_view = view_axes(view, axes);
  const Vector2d tangents = tangents_of(options);
  Camera camera;
  camera.eye = (eye * frame.scale).cast<float>();
  camera.right = to_view.row(0).transpose().cast<float>();
  camera.up = to_view.row(1).transpose().cast<float>();
  camera.forward = -view.cast<float>();
  camera.tangent_x = static_cast<float>(tangents.x());
  camera.tangent_y = static_cast<float>(tangents.y());
  camera.world_up = axes.up.cast<float>();
  // Slightly below the shape, so that a flat sheet lies on the ground and not in it.
  camera.ground_height =
      static_cast<float>(((frame.lowest - frame.centre) * frame.scale).dot(axes.up.transpose())) - kMargin;
  return camera;
}

}  // namespace batten::render_detail
