#include "batten/render/paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace batten::render_detail {
namespace {

constexpr int kLevelColors = 1024;
/// The share of a given colour that is drawn whatever the light.
constexpr float kColorGlow = 0.5F;
/// The same for colours that measure, which must be found on the bar.
constexpr float kLevelGlow = 0.9F;

Vec to_vec(const Color& color) { return {color[0], color[1], color[2]}; }

/// Moves a point of a facet towards the round surface that its corners' normals describe, if that is outside. This
/// keeps shadows of the facets' own corners off the terminator (Hanika 2021).
Vec round_origin(const Vec& point, const std::array<Vec, 3>& corners, const std::array<Vec, 3>& normals,
                 const Vec& weights) {
  Vec shift = Vec::Zero();
  for (int i = 0; i < 3; ++i)
    shift -= weights[i] *
             std::min(0.0F, (point - corners[static_cast<std::size_t>(i)]).dot(normals[static_cast<std::size_t>(i)])) *
             normals[static_cast<std::size_t>(i)];
  return point + shift;
}

}  // namespace

Paint::Paint(const Scene& scene, const RenderOptions& options, const Triangles& triangles, const Lamps& lamps)
    : triangles_(triangles),
      lamps_(lamps),
      zebra_(options.shading == Shading::Zebra),
      surface_color_(to_vec(scene.surface_color)),
      back_color_(to_vec(scene.back_color)),
      marker_color_(to_vec(scene.marker_color)),
      line_color_(to_vec(scene.line_color)) {
  for (const double value : scene.marker_scalars)
    marker_levels_.push_back(static_cast<float>(scene.scale.position(value)));
  if (triangles.levels.empty() && marker_levels_.empty() && scene.line_scalars.size() == 0) return;
  for (int i = 0; i < kLevelColors; ++i)
    level_colors_.push_back(to_vec(map_color(scene.scale.map, i / (kLevelColors - 1.0))));
  level_colors_.push_back(to_vec(map_color(scene.scale.map, std::numeric_limits<double>::quiet_NaN())));
}

Surfel Paint::surfel(unsigned triangle, float u, float v, const Vec& towards) const {
  const std::size_t corner = 3 * static_cast<std::size_t>(triangle);
  const Vec weights(1.0F - u - v, u, v);
  std::array<Vec, 3> corners;
  std::array<Vec, 3> normals;
  Surfel surfel;
  surfel.position = Vec::Zero();
  surfel.normal = Vec::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const float weight = weights[static_cast<Eigen::Index>(i)];
    corners[i] = triangles_.points[triangles_.vertices[corner + i]];
    normals[i] = triangles_.normals[triangles_.normal_row(corner + i)];
    surfel.position += weight * corners[i];
    surfel.normal += weight * normals[i];
  }
  surfel.geometric = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  surfel.is_back = surfel.geometric.dot(towards) > 0.0F;
  surfel.geometric *= surfel.is_back ? -1.0F : 1.0F;
  const float length = surfel.normal.norm();
  surfel.normal = length > 0.0F ? Vec(surfel.normal / length) : surfel.geometric;
  // The given normals may point either way.
  const float side = surfel.normal.dot(surfel.geometric) < 0.0F ? -1.0F : 1.0F;
  surfel.normal *= side;
  for (Vec& normal : normals) normal *= normal.dot(surfel.geometric) < 0.0F ? -1.0F : 1.0F;
  surfel.origin = round_origin(surfel.position, corners, normals, weights);
  return surfel;
}

Shine Paint::shine(const Surfel& surfel, unsigned triangle, float u, float v, const Vec& towards) const {
  const std::size_t corner = 3 * static_cast<std::size_t>(triangle);
  const Vec weights(1.0F - u - v, u, v);
  Surfel painted = surfel;
  if (white_) {
    painted.albedo = Vec::Ones();
    painted.gloss = 0.0F;
  } else if (zebra_) {
    painted.albedo = zebra_albedo(lamps_, surfel.normal, towards);
  } else if (surfel.is_back) {
    painted.albedo = back_color_;
  } else if (!triangles_.levels.empty()) {
    float level = 0.0F;
    for (std::size_t i = 0; i < 3; ++i)
      level += weights[static_cast<Eigen::Index>(i)] * triangles_.levels[triangles_.vertices[corner + i]];
    painted.albedo = level_color(level);
    return {faint_light(lamps_, painted), kLevelGlow * painted.albedo};
  } else if (!triangles_.colors.empty()) {
    Vec color = Vec::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      color += weights[static_cast<Eigen::Index>(i)] * triangles_.colors[triangles_.vertices[corner + i]];
    painted.albedo = (1.0F - kColorGlow) * color.cwiseProduct(exposure_);
    painted.gloss = 0.0F;
    return {reflect(lamps_, painted, towards), kColorGlow * color};
  } else {
    painted.albedo = surface_color_;
  }
  return {reflect(lamps_, painted, towards), Vec::Zero()};
}

Vec Paint::overlay_color(const Overlay& overlay, Part part, unsigned number) const {
  if (part == Part::Markers) return marker_levels_.empty() ? marker_color_ : level_color(marker_levels_[number]);
  const float level =
      overlay.line_levels.empty() ? std::numeric_limits<float>::quiet_NaN() : overlay.line_levels[number];
  return std::isnan(level) ? line_color_ : level_color(level);
}

Vec Paint::level_color(float level) const {
  if (std::isnan(level)) return level_colors_.back();
  const int place = std::clamp(static_cast<int>(std::lround(level * (kLevelColors - 1))), 0, kLevelColors - 1);
  return level_colors_[static_cast<std::size_t>(place)];
}

}  // namespace batten::render_detail
