#include "batten/render/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/parallel/parallel.h"
#include "batten/render/srgb.h"

namespace batten::render_detail {
namespace {

constexpr float kKeyRadius = 0.22F;  // the tangent of half of the angle of the key light's disc
const Vec kKeyColor(1.62F, 1.52F, 1.38F);
const Vec kSkyColor(0.37F, 0.41F, 0.47F);
const Vec kBounceColor(0.27F, 0.24F, 0.21F);
const Vec kFillColor(0.13F, 0.15F, 0.19F);
constexpr float kGloss = 0.15F;
constexpr float kRim = 0.22F;

/// The share of each colour of the background that remains on the ground in full shadow.
const Vec kGroundShadow(0.27F, 0.285F, 0.31F);
constexpr float kGroundKeyShare = 0.55F;

/// Linear up to kKnee, then a shoulder that tends to 1.
float tone(float x) {
  constexpr float kKnee = 0.62F;
  return x < kKnee ? x : kKnee + (1.0F - kKnee) * (1.0F - std::exp((kKnee - x) / (1.0F - kKnee)));
}

/// sRGB bytes of linear values in [0, 1], from a table that is fine enough for the steep start of the curve.
class ByteTable {
 public:
  ByteTable() : bytes_(kSteps + 1) {
    for (int i = 0; i <= kSteps; ++i)
      bytes_[static_cast<std::size_t>(i)] =
          static_cast<unsigned char>(std::lround(255.0F * encode_srgb(static_cast<float>(i) / kSteps)));
  }
  unsigned char operator()(float linear) const {
    return bytes_[static_cast<std::size_t>(std::lround(std::clamp(linear, 0.0F, 1.0F) * kSteps))];
  }

 private:
  static constexpr int kSteps = 1 << 15;
  std::vector<unsigned char> bytes_;
};

/// The opacity of a black shadow that leaves the share `left` of the background beside the shape.
float shadow_opacity(float background, float coverage, float left) {
  if (coverage >= 1.0F || background <= 0.0F) return 0.0F;
  const float kept = std::clamp(left / (1.0F - coverage), 0.0F, 1.0F);
  return (1.0F - coverage) * (1.0F - encode_srgb(background * kept) / encode_srgb(background));
}

/// Combines the shape's colour and the black shadow behind it into one colour with alpha.
void set_alpha(unsigned char* pixel, float coverage, float shadow) {
  const float alpha = std::min(1.0F, coverage + shadow);
  const float share = alpha > 0.0F ? coverage / alpha : 0.0F;
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<unsigned char>(std::lround(share * static_cast<float>(pixel[c])));
  pixel[3] = static_cast<unsigned char>(std::lround(255.0F * alpha));
}

}  // namespace

Lamps::Lamps(const Camera& camera) : up(camera.world_up) {
  // The key light is at the eye's upper left with respect to the shape's own up direction, or the picture's top if seen
  // from straight above.
  const Vec left = -camera.right;
  Vec towards = -camera.forward + up.dot(camera.forward) * up;
  if (towards.norm() < 1e-3F) towards = camera.up;
  towards.normalize();
  key = (0.50F * left + 0.62F * towards + 1.05F * up).normalized();
  fill = (0.85F * camera.right + 0.45F * towards + 0.15F * up).normalized();
  zebra_axis = (0.88F * camera.right + 0.42F * camera.up + 0.22F * camera.forward).normalized();
  key_side = key.unitOrthogonal();
  key_rise = key.cross(key_side);
}

float Lamps::key_cosine(const Vec& normal) const {
  const float cosine = normal.dot(key);
  if (cosine >= kKeyRadius) return cosine;
  const float part = std::max(0.0F, cosine + kKeyRadius);
  return part * part / (4.0F * kKeyRadius);
}

Vec Lamps::key_direction(float u, float v) const {
  const float radius = kKeyRadius * std::sqrt(u);
  const float angle = 2.0F * std::numbers::pi_v<float> * v;
  return (key + radius * std::cos(angle) * key_side + radius * std::sin(angle) * key_rise).normalized();
}

Light reflect(const Lamps& lamps, const Surfel& surfel, const Vec& direction) {
  const Vec& normal = surfel.normal;
  const float cosine = lamps.key_cosine(normal);
  const Vec half = (lamps.key - direction).normalized();
  const float along = std::max(0.0F, half.dot(normal));
  const float power4 = along * along * along * along;
  const float power16 = power4 * power4 * power4 * power4;
  const float gloss = surfel.gloss * kGloss * power16 * power16 * std::min(1.0F, 8.0F * cosine);
  const float facing = std::clamp(1.0F + direction.dot(normal), 0.0F, 1.0F);
  const float rim = surfel.gloss * kRim * facing * facing * facing * facing;
  const float height = 0.5F + 0.5F * normal.dot(lamps.up);
  const Vec sky = height * kSkyColor + (1.0F - height) * kBounceColor;
  const Vec fill = std::max(0.0F, normal.dot(lamps.fill)) * kFillColor;
  Light light;
  light.key = (cosine * surfel.albedo + Vec::Constant(gloss)).cwiseProduct(kKeyColor);
  light.ambient = surfel.albedo.cwiseProduct(sky + fill) + rim * sky;
  return light;
}

Light faint_light(const Lamps& lamps, const Surfel& surfel) {
  constexpr float kKey = 0.07F;
  constexpr float kSky = 0.03F;
  return {kKey * lamps.key_cosine(surfel.normal) * surfel.albedo, kSky * surfel.albedo};
}

Vec lit_color(const Layers& layers, std::size_t pixel) {
  const auto key = static_cast<std::size_t>(Plane::KeyRed);
  const auto ambient = static_cast<std::size_t>(Plane::AmbientRed);
  Vec lit;
  for (std::size_t c = 0; c < 3; ++c)
    lit[static_cast<Eigen::Index>(c)] = layers.planes[key + c][pixel] * layers.plane(Plane::KeySeen)[pixel] +
                                        layers.planes[ambient + c][pixel] * layers.plane(Plane::SkySeen)[pixel];
  return lit;
}

Vec sky_direction(const Vec& normal, float u, float v) {
  // An orthonormal frame without a branch for small components (Duff et al. 2017).
  const float sign = std::copysign(1.0F, normal.z());
  const float a = -1.0F / (sign + normal.z());
  const float b = normal.x() * normal.y() * a;
  const Vec side(1.0F + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x());
  const Vec rise(b, sign + normal.y() * normal.y() * a, -normal.y());
  const float radius = std::sqrt(u);
  const float angle = 2.0F * std::numbers::pi_v<float> * v;
  return radius * std::cos(angle) * side + radius * std::sin(angle) * rise +
         std::sqrt(std::max(0.0F, 1.0F - u)) * normal;
}

Eigen::Vector2f spread_point(std::uint32_t i) {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t bit = 1U << 31;
  std::uint32_t column = 1U << 31;
  for (; i != 0; i >>= 1, bit >>= 1, column ^= column >> 1) {
    if ((i & 1U) == 0) continue;
    x ^= bit;
    y ^= column;
  }
  constexpr float kUnit = 1.0F / 4294967296.0F;
  return {static_cast<float>(x >> 8) * 256.0F * kUnit, static_cast<float>(y >> 8) * 256.0F * kUnit};
}

float ground_share(float distance) {
  const float t = std::clamp((kGroundEnd - distance) / (kGroundEnd - 1.4F), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

void develop(const Layers& layers, const PictureStyle& style, Picture& picture) {
  const ByteTable bytes;
  const auto width = static_cast<std::size_t>(layers.width);
  const std::size_t channels = style.transparent ? 4 : 3;
  picture.width = layers.width;
  picture.height = layers.height;
  picture.channels = static_cast<int>(channels);
  picture.pixels.resize(channels * width * static_cast<std::size_t>(layers.height));
  const auto glow = static_cast<std::size_t>(Plane::GlowRed);
  const auto at = [&](Plane plane, std::size_t i) { return layers.plane(plane)[i]; };
  parallel_for_each(layers.height, [&](std::ptrdiff_t y) {
    for (std::size_t i = static_cast<std::size_t>(y) * width; i < (static_cast<std::size_t>(y) + 1) * width; ++i) {
      const float coverage = at(Plane::Coverage, i);
      const float ground = at(Plane::GroundWeight, i);
      const float solid = at(Plane::Solid, i);
      const Vec lit = solid > 0.0F ? lit_color(layers, i) : Vec(Vec::Zero());
      const float seen =
          kGroundKeyShare * at(Plane::GroundKeySeen, i) + (1.0F - kGroundKeyShare) * at(Plane::GroundSkySeen, i);
      unsigned char* pixel = picture.pixels.data() + channels * i;
      float opacity = 0.0F;  // of the shadow; in sRGB, in which viewers blend
      for (std::size_t c = 0; c < 3; ++c) {
        const float shade = 1.0F - (1.0F - kGroundShadow[static_cast<Eigen::Index>(c)]) * (1.0F - seen);
        const float left = 1.0F - coverage - ground * (1.0F - shade);
        const float shape = solid * tone(lit[static_cast<Eigen::Index>(c)]) + layers.planes[glow + c][i];
        if (style.transparent) {
          opacity += shadow_opacity(style.background[c], coverage, left) / 3.0F;
          pixel[c] = bytes(coverage > 0.0F ? shape / coverage : 0.0F);
        } else {
          pixel[c] = bytes(style.background[c] * left + shape);
        }
      }
      if (style.transparent) set_alpha(pixel, coverage, opacity);
    }
  });
}

Vec zebra_albedo(const Lamps& lamps, const Vec& normal, const Vec& towards) {
  constexpr float kBands = 10.0F;
  constexpr float kEdge = 0.06F;  // the soft edge of a band
  constexpr float kGrazing = 0.22F;
  const Vec dark_paint(0.012F, 0.020F, 0.045F);
  const Vec light_paint(0.62F, 0.60F, 0.55F);
  const Vec mirrored = towards - 2.0F * normal.dot(towards) * normal;
  // Bands of equal width in the angle from a slanted axis, so that no pole is in the middle of the picture.
  const float angle = std::acos(std::clamp(mirrored.dot(lamps.zebra_axis), -1.0F, 1.0F));
  const float place = kBands * angle / std::numbers::pi_v<float>;
  const float inside = std::abs(2.0F * (place - std::floor(place)) - 1.0F);  // 1 in the middle of a dark band
  const float t = std::clamp((inside - 0.5F) / kEdge + 0.5F, 0.0F, 1.0F);
  // Towards the silhouette the bands become finer than a pixel and would flicker.
  const float contrast = std::min(1.0F, std::abs(normal.dot(towards)) / kGrazing);
  const float dark = 0.5F + contrast * (t - 0.5F);
  return dark * dark_paint + (1.0F - dark) * light_paint;
}

}  // namespace batten::render_detail
