/// \file Markers and lines: their sizes in the picture, and whether they leave enough of the surface to be seen.
#pragma once
#include <string>
#include <vector>

#include "batten/render/eye.h"
#include "batten/render/rays.h"

namespace batten::render_detail {

/// How many pixels wide a line is and how large the radius of a marker. Those that have numbers are larger, because
/// their colours are to be read.
struct OverlaySizes {
  float line_width;
  float marker_radius;
};

OverlaySizes standard_sizes(const Scene& scene, int width, int height);

/// The markers and lines, with the radii of the options or, where these are 0, such that they have `sizes` in the
/// middle of the picture. Throws Error(BadArgument) for radii that are negative or not finite.
Overlay overlay_of(const Scene& scene, const Frame& frame, const RenderOptions& options, const Eye& eye,
                   const OverlaySizes& sizes);

/// The share of the surface, as the eye sees it, that is behind lines and behind markers.
struct OverlayShares {
  double lines = 0.0;
  double markers = 0.0;
};

/// Measured with 65,536 rays.
OverlayShares measure_overlay(const Rays& rays, const Overlay& overlay, const Eye& eye);

/// The overlay of the standard sizes, or thinner where it would cover more than a fifth of the surface. Lines and
/// markers that would do so even at the smallest size are left out, unless they have numbers or a radius of the
/// options; notes (may be null) gets a sentence for each kind left out. The overlay is what `rays` show afterwards.
Overlay show_overlay(const Scene& scene, const Frame& frame, const RenderOptions& options, const Eye& eye, Rays& rays,
                     std::vector<std::string>* notes);

/// How opaque a marker or a line is so far behind the surface, in the frame's unit; negative in front of it. Lines
/// behind the surface stay faintly visible, more so just below it.
float overlay_opacity(Part part, float behind, float radius);

}  // namespace batten::render_detail
