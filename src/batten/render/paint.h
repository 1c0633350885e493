/// \file What the surface, the markers and the lines look like, before light.
#pragma once
#include <vector>

#include "batten/render/light.h"
#include "batten/render/rays.h"

namespace batten::render_detail {

/// The light that a sample sends to the eye.
struct Shine {
  Light lit;  ///< that comes from the lamps
  Vec glow;   ///< that needs no lamp
};

/// Refers to the triangles and the lamps, which must outlive it.
class Paint {
 public:
  Paint(const Scene& scene, const RenderOptions& options, const Triangles& triangles, const Lamps& lamps);

  /// Makes everything matt white.
  void whiten() { white_ = true; }

  /// Given colours are multiplied by this light, so that they come out as they are where the light is ordinary.
  void expose(const Vec& exposure) { exposure_ = exposure; }

  /// The point (u, v) of a triangle, seen along `towards`, without its albedo.
  Surfel surfel(unsigned triangle, float u, float v, const Vec& towards) const;
  Shine shine(const Surfel& surfel, unsigned triangle, float u, float v, const Vec& towards) const;
  /// The colour of a marker or a tube.
  Vec overlay_color(const Overlay& overlay, Part part, unsigned number) const;

 private:
  Vec level_color(float level) const;

  const Triangles& triangles_;
  const Lamps& lamps_;
  const bool zebra_;
  bool white_ = false;
  Vec exposure_ = Vec::Ones();
  Vec surface_color_;
  Vec back_color_;
  Vec marker_color_;
  Vec line_color_;
  std::vector<float> marker_levels_;  ///< positions on the colour scale, or empty
  /// Of the colour scale from its low end to its high end, followed by the colour of NaN.
  std::vector<Vec> level_colors_;
};

}  // namespace batten::render_detail
