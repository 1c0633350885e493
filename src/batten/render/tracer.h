/// \file Traces rays and stores the results in layers, one square of pixels at a time.
#pragma once
#include "batten/render/overlay.h"
#include "batten/render/paint.h"

namespace batten::render_detail {

struct Square;

/// Tracing is const: several threads may trace squares at once.
class Tracer {
 public:
  static constexpr int kSquare =
      32;  ///< a multiple of the pattern's block, so that the samples' pattern does not break

  /// Refers to everything but the options.
  Tracer(const Eye& eye, const RenderOptions& options, const Rays& rays, const Overlay& overlay, const Lamps& lamps,
         const Paint& paint);

  /// Fills the layers, which have the size of the eye's picture. Reports from 0 to 1.
  void trace(Layers& layers, const Progress& progress) const;

 private:
  /// Fills the layers' pixels in [left, left + kSquare) by [top, top + kSquare) that are inside the picture.
  void trace_square(int left, int top, Layers& layers) const;

  void trace_eye_rays(Square& square) const;
  /// Returns the share of the light from behind the overlay that reaches the eye.
  float take_overlay(Square& square, std::size_t sample, const RTCRayHit16& overlay, const RTCRayHit16& surface,
                     int lane) const;
  void take_surface(Square& square, std::size_t sample, const Vec& towards, const RTCRayHit16& rays, int lane,
                    float left) const;
  void take_ground(Square& square, std::size_t sample, const Vec& towards) const;
  void trace_light_rays(Square& square) const;
  /// The share of a shadow that is drawn at a pixel. It is 0 at the picture's edge, so that no seam shows on a page.
  float frame_share(int x, int y) const;
  int pattern_row(const Square& square, std::size_t sample) const;

  const Eye& eye_;
  const Rays& rays_;
  const Overlay& overlay_;
  const Lamps& lamps_;
  const Paint& paint_;
  const int samples_;  ///< for each pixel
  const bool has_ground_;
  std::vector<Eigen::Vector2f> offsets_;  ///< of a pixel's samples, in pixels
  std::vector<Eigen::Vector2f> pattern_;  ///< of all samples of a block of pixels
  std::vector<Vec> key_directions_;       ///< for each row of the pattern
};

}  // namespace batten::render_detail
