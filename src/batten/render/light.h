/// \file Lamps, materials, sample patterns, and the final colours of the picture.
#pragma once
#include <cstdint>

#include "batten/render/layers.h"
#include "batten/render/view.h"

namespace batten::render_detail {

/// What one sample sees.
struct Surfel {
  Vec position;
  Vec origin;  ///< the start of its shadow rays: not on the facets but on the round surface that the normals describe
  Vec normal;  ///< for shading; on the eye's side
  Vec geometric;         ///< of the facet; on the eye's side
  bool is_back = false;  ///< the eye sees the facet's back side
  Vec albedo;
  float gloss = 1.0F;  ///< the share of the usual highlights and of the usual rim
};

struct Lamps {
  Vec key;       ///< the direction of the key light
  Vec key_side;  ///< spans the light's disc together with key_rise
  Vec key_rise;
  Vec fill;
  Vec up;
  Vec zebra_axis;  ///< of the bands of Shading::Zebra

  explicit Lamps(const Camera& camera);

  /// The share of the key light's disc that is above a surface, times the cosine.
  float key_cosine(const Vec& normal) const;
  Vec key_direction(float u, float v) const;
};

struct Light {
  Vec key;
  Vec ambient;
};

/// Diffuse reflection and a soft gloss in the direction -direction.
Light reflect(const Lamps& lamps, const Surfel& surfel, const Vec& direction);

/// At most a tenth of the albedo, without any colour of the lamps: the shading of colours that are to be read.
Light faint_light(const Lamps& lamps, const Surfel& surfel);

/// The light of a pixel in each colour, before the tone curve: what the lamps send, as far as it is not blocked.
Vec lit_color(const Layers& layers, std::size_t pixel);

/// A cosine-weighted direction around the normal for (u, v) in the unit square.
Vec sky_direction(const Vec& normal, float u, float v);

/// Point `i` of a sequence in which each run of 4^k points, starting at a multiple of 4^k, is spread evenly over the
/// unit square (Sobol's first two dimensions).
Eigen::Vector2f spread_point(std::uint32_t i);

/// The strength of a shadow on the ground by distance from the shape's centre: 1 near it, 0 from kGroundEnd on.
inline constexpr float kGroundEnd = 3.6F;
float ground_share(float distance);

/// Combines the layers into a picture.
void develop(const Layers& layers, const PictureStyle& style, Picture& picture);

/// The colour of a surface that mirrors light and dark bands, for rays along `towards`.
Vec zebra_albedo(const Lamps& lamps, const Vec& normal, const Vec& towards);

}  // namespace batten::render_detail
