/// \file Traces rays and stores the results in layers, one square of pixels at a time.
#pragma once
#include "batten/render/light.h"
#include "batten/render/rays.h"

namespace batten::render_detail {

struct Square;

/// Tracing is const: several threads may trace squares at once.
class Tracer {
 public:
  static constexpr int kSquare =
      32;  ///< a multiple of the pattern's block, so that the samples' pattern does not break

  Tracer(const Scene& scene, const RenderOptions& options, const Triangles& triangles, const Rays& rays,
         const Camera& camera);

  /// Fills the layers' pixels in [left, left + kSquare) by [top, top + kSquare) that are inside the picture.
  void trace_square(int left, int top, Layers& layers) const;

 private:
  Vec direction(float x, float y) const;
  void trace_eye_rays(Square& square) const;
  void take_hit(Square& square, std::size_t sample, const Vec& towards, const RTCRayHit16& rays, int lane) const;
  void take_ground(Square& square, std::size_t sample, const Vec& towards) const;
  void trace_light_rays(Square& square) const;
  /// The share of a shadow that is drawn at a pixel. It is 0 at the picture's edge, so that no seam shows on a page.
  float frame_share(int x, int y) const;
  int pattern_row(const Square& square, std::size_t sample) const;
  Surfel surface_surfel(unsigned triangle, float u, float v, const Vec& towards) const;
  Vec level_color(float level) const;
  Surfel overlay_surfel(Part part, unsigned number, const Vec& position, const Vec& normal) const;

  const Triangles& triangles_;
  const Rays& rays_;
  const Camera camera_;
  const Lamps lamps_;
  const int width_;
  const int height_;
  const int samples_;  ///< for each pixel
  const bool has_ground_;
  const bool zebra_;
  Vec surface_color_;
  Vec back_color_;
  Vec marker_color_;
  Vec line_color_;
  std::vector<float> marker_levels_;  ///< positions on the colour scale, or empty
  /// Of the colour scale from its low end to its high end, followed by the colour of NaN.
  std::vector<Vec> level_colors_;
  std::vector<Eigen::Vector2f> offsets_;  ///< of a pixel's samples, in pixels
  std::vector<Eigen::Vector2f> pattern_;  ///< of all samples of a block of pixels
  std::vector<Vec> key_directions_;       ///< for each row of the pattern
};

}  // namespace batten::render_detail
