/// \file The eye's position: the default view and the fit.
#pragma once
#include "batten/render/geometry.h"

namespace batten::render_detail {

/// In the frame's unit. The ray of a pixel goes from `eye` along forward + x * right + y * up, where x and y are
/// tangents in [-tangent_x, tangent_x] and [-tangent_y, tangent_y].
struct Camera {
  Vec eye;
  Vec right;
  Vec up;
  Vec forward;
  float tangent_x;
  float tangent_y;
  Vec world_up;         ///< the scene's up direction
  float ground_height;  ///< the lowest point along world_up
};

using Scenes = std::vector<const Scene*>;

/// The axis asked for, or guess_up_axis of the first scene's surface, lines or markers.
UpAxis resolve_up(const Scenes& scenes, UpAxis asked);

/// The normal of the surfaces if all lie in one plane, to 1/500 of their size; zero otherwise. On the side of most of
/// the faces' area.
Eigen::Vector3d flat_normal(const Scenes& scenes, const Frame& frame);

/// See fit_viewpoint and turntable. Throws Error(BadArgument) for a direction that is zero or not finite.
Viewpoint fitted_viewpoint(const Scenes& scenes, const RenderOptions& options);
std::vector<Viewpoint> turned_viewpoints(const Scenes& scenes, const RenderOptions& options, int count);

/// The camera of options.viewpoint if given, otherwise of the fitted one.
Camera camera_of(const Scene& scene, const Frame& frame, const RenderOptions& options);

}  // namespace batten::render_detail
