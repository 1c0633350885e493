#include "batten/render/render.h"

#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
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

Picture render(const Scene& scene, const RenderOptions& options, const Progress& progress) {
  check_options(options);
  check_scene(scene);
  report(progress, 0.0);
  const Frame frame = frame_of({&scene});
  const Camera camera = camera_of(scene, frame, options);
  const Triangles triangles = triangles_of(scene, frame);
  const Overlay overlay = overlay_of(scene, frame, options);
  report(progress, 0.1);
  const Rays rays(triangles, overlay);
  const Tracer tracer(scene, options, triangles, rays, camera);
  Layers layers(options.width, options.height);
  const int across = (options.width + Tracer::kSquare - 1) / Tracer::kSquare;
  const int down = (options.height + Tracer::kSquare - 1) / Tracer::kSquare;
  for (int row = 0; row < down; ++row) {
    report(progress, 0.3 + 0.6 * row / down);
    parallel_for_each(across, [&](std::ptrdiff_t column) {
      tracer.trace_square(static_cast<int>(column) * Tracer::kSquare, row * Tracer::kSquare, layers);
    });
  }
  report(progress, 0.9);
  smooth_light(layers, 2.0F * camera.tangent_y * camera.eye.norm() / static_cast<float>(options.height));
  Picture picture;
  develop(layers, options.style, picture);
  report(progress, 1.0);
  return picture;
}

}  // namespace batten
