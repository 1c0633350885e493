#include "batten/render/render.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/quantile.h"
#include "batten/render/srgb.h"
#include "batten/render/tracer.h"

namespace batten {
namespace {

using namespace render_detail;

constexpr int kLargestSide = 32768;
constexpr int kMostSamples = 16;

void check_options(const RenderOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > kLargestSide || options.height > kLargestSide)
    throw Error(ErrorCode::BadArgument, "a picture's width and height must be 1 to " + std::to_string(kLargestSide));
  if (options.samples < 1 || options.samples > kMostSamples)
    throw Error(ErrorCode::BadArgument, "samples per axis must be 1 to " + std::to_string(kMostSamples));
  for (const float part : options.style.background) {
    if (!std::isfinite(part)) throw Error(ErrorCode::NotFinite, "the background's colour is not finite");
  }
}

void check_scenes(const std::vector<const Scene*>& scenes, const RenderOptions& options) {
  check_options(options);
  if (scenes.empty()) throw Error(ErrorCode::BadArgument, "there is no scene to fit into a picture");
  for (const Scene* scene : scenes) check_scene(*scene);
}

/// The exposure at which the median of the surface, were it white, is white in each colour; from a small picture.
Vec measure_exposure(const Eye& eye, RenderOptions options, const Rays& rays, const Lamps& lamps, Paint paint) {
  constexpr int kSide = 200;
  constexpr float kLeast = 0.2F;
  constexpr float kMost = 5.0F;
  const int side = std::max({eye.width, eye.height, kSide});
  const Eye small{eye.camera, std::max(1, eye.width * kSide / side), std::max(1, eye.height * kSide / side)};
  options.samples = 1;
  options.ground = Ground::None;
  paint.whiten();
  Layers layers(small.width, small.height);
  Tracer(small, options, rays, Overlay(), lamps, paint).trace(layers, {});
  smooth_light(layers, small.pixel_size());
  std::array<std::vector<float>, 3> light;
  for (std::size_t i = 0; i < layers.plane(Plane::Solid).size(); ++i) {
    if (layers.plane(Plane::Solid)[i] < 1.0F) continue;
    const Vec lit = lit_color(layers, i);
    for (std::size_t c = 0; c < 3; ++c) light[c].push_back(lit[static_cast<Eigen::Index>(c)]);
  }
  Vec exposure = Vec::Ones();
  for (std::size_t c = 0; c < 3 && !light[c].empty(); ++c)
    exposure[static_cast<Eigen::Index>(c)] = std::clamp(1.0F / std::max(quantile(light[c], 0.5), 1e-3F), kLeast, kMost);
  return exposure;
}

void report(const Progress& progress, double done) {
  if (progress && !progress(done)) throw Error(ErrorCode::Cancelled, "the picture was cancelled");
}

}  // namespace

Viewpoint fit_viewpoint(const std::vector<const Scene*>& scenes, const RenderOptions& options) {
  check_scenes(scenes, options);
  return fitted_viewpoint(scenes, options);
}

std::vector<Viewpoint> turntable(const std::vector<const Scene*>& scenes, const RenderOptions& options, int count) {
  check_scenes(scenes, options);
  return turned_viewpoints(scenes, options, count);
}

PictureStyle style_beside(const Scene& scene, PictureStyle style) {
  constexpr Color kGrey{0.50F, 0.50F, 0.50F};
  constexpr float kStep = 0.08F;  // of sRGB's range
  constexpr double kMostNear = 0.05;
  Eigen::Index near = 0;
  for (Eigen::Index i = 0; i < scene.colors.rows(); ++i) {
    float most = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      const float color = encode_srgb(static_cast<float>(scene.colors(i, static_cast<Eigen::Index>(c))));
      most = std::max(most, std::abs(color - encode_srgb(style.background[c])));
    }
    near += most < kStep ? 1 : 0;
  }
  if (static_cast<double>(near) > kMostNear * static_cast<double>(scene.colors.rows())) style.background = kGrey;
  return style;
}

Picture render(const Scene& scene, const RenderOptions& options, const Progress& progress,
               std::vector<std::string>* notes) {
  check_options(options);
  check_scene(scene);
  report(progress, 0.0);
  const Frame frame = frame_of({&scene});
  const Eye eye{camera_of(scene, frame, options), options.width, options.height};
  const Triangles triangles = triangles_of(scene, frame);
  report(progress, 0.1);
  Rays rays(triangles);
  const Lamps lamps(eye.camera);
  Paint paint(scene, options, triangles, lamps);
  if (!triangles.colors.empty()) paint.expose(measure_exposure(eye, options, rays, lamps, paint));
  const Overlay overlay = show_overlay(scene, frame, options, eye, rays, notes);
  Layers layers(options.width, options.height);
  const Tracer tracer(eye, options, rays, overlay, lamps, paint);
  tracer.trace(layers, [&](double done) { return !progress || progress(0.3 + 0.6 * done); });
  report(progress, 0.9);
  smooth_light(layers, eye.pixel_size());
  Picture picture;
  develop(layers, options.style, picture);
  report(progress, 1.0);
  return picture;
}

}  // namespace batten
