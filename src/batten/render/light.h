/// \file Lamps, materials, the pattern of samples, and what becomes of light in the picture.
#pragma once
#include <cstdint>

#include "batten/render/layers.h"
#include "batten/render/view.h"

namespace batten::render_detail {

/// What is seen through one sample.
struct Surfel {
  Vec position;
  Vec origin;     ///< where its shadow rays start: off the facets, on the round surface that the normals describe
  Vec normal;     ///< for shading; on the eye's side
  Vec geometric;  ///< of the facet; on the eye's side
  Vec albedo;
  float gloss = 1.0F;  ///< of the usual gloss
};

struct Lamps {
  Vec key;       ///< towards it
  Vec key_side;  ///< spans its disc with key_rise
  Vec key_rise;
  Vec fill;
  Vec up;
  Vec zebra_axis;  ///< of the bands of Shading::Zebra

  explicit Lamps(const Camera& camera);

  /// The share of the key's disc above a surface, times the cosine.
  float key_cosine(const Vec& normal) const;
  Vec key_direction(float u, float v) const;
};

struct Light {
  Vec key;
  Vec ambient;
};

/// Diffuse and a soft gloss, towards -direction.
Light reflect(const Lamps& lamps, const Surfel& surfel, const Vec& direction);

/// Cosine-weighted around the normal, for (u, v) in the unit square.
Vec sky_direction(const Vec& normal, float u, float v);

/// Point `i` of a sequence of which each run of 4^k from a multiple of 4^k is spread evenly over the unit square
/// (Sobol's first two dimensions).
Eigen::Vector2f spread_point(std::uint32_t i);

/// How much the ground takes a shadow, at a distance from the shape's centre: 1 near it, 0 from kGroundEnd on.
inline constexpr float kGroundEnd = 3.6F;
float ground_share(float distance);

/// Puts the layers together.
void develop(const Layers& layers, const PictureStyle& style, Picture& picture);

/// Of the surface that mirrors bands of light and dark, for rays along `towards`.
Vec zebra_albedo(const Lamps& lamps, const Vec& normal, const Vec& towards);

}  // namespace batten::render_detail
