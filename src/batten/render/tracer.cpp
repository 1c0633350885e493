#include "batten/render/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten::render_detail {
namespace {

constexpr float kLift = 2e-4F;     // the distance from the surface at which shadow rays start
constexpr float kSkyReach = 0.9F;  // objects beyond this distance do not block the sky
constexpr float kGroundSkyReach = 0.6F;
constexpr int kLevelColors = 1024;
// With this albedo, a surface that faces the lights has exactly the colours of its bar.
constexpr float kDataAlbedo = 0.66F;
constexpr float kDataGloss = 0.25F;
constexpr int kFrame = 8;  // pixels at the picture's edge that are exactly the background, whatever the smoothing does
constexpr float kEverywhere = 100.0F;  // beyond everything inside or near the unit sphere

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

constexpr int kBlock = 8;  // the pattern of light rays covers a block of so many pixels in each direction

/// The index of pixel (x, y) in its block. The indices of each square of 2x2 and of 4x4 are consecutive.
int block_place(int x, int y) {
  int place = 0;
  for (int bit = 0; (1 << bit) < kBlock; ++bit) place |= ((x >> bit & 1) | (y >> bit & 1) << 1) << 2 * bit;
  return place;
}

/// Sums over the samples of one pixel.
struct PixelSums {
  std::array<float, kPlaneCount> sums{};

  float& operator[](Plane plane) { return sums[static_cast<std::size_t>(plane)]; }
  void add(Plane first, const Vec& v) {
    for (int i = 0; i < 3; ++i) sums[static_cast<std::size_t>(first) + static_cast<std::size_t>(i)] += v[i];
  }
};

/// A point for which light rays are still to be traced.
struct Shade {
  Vec origin;
  Vec normal;
  Vec geometric;
  int pixel;
  int pattern;         ///< the row of the pattern
  float ground_share;  ///< negative for the shape
};

/// Sixteen rays that only determine whether something blocks them.
class LightPacket {
 public:
  explicit LightPacket(const Rays& rays) : rays_(rays) {}

  /// When the packet is full, calls seen(shade, unblocked) for each of its rays.
  template <typename Seen>
  void add(const Shade& shade, const Vec& towards, float reach, const Seen& seen) {
    const Vec origin = shade.origin + kLift * shade.geometric;
    packet_.org_x[count_] = origin.x();
    packet_.org_y[count_] = origin.y();
    packet_.org_z[count_] = origin.z();
    packet_.dir_x[count_] = towards.x();
    packet_.dir_y[count_] = towards.y();
    packet_.dir_z[count_] = towards.z();
    packet_.tnear[count_] = 0.0F;
    packet_.tfar[count_] = reach;
    packet_.time[count_] = 0.0F;
    packet_.mask[count_] = ~0U;
    packet_.flags[count_] = 0;
    shades_[static_cast<std::size_t>(count_)] = &shade;
    if (++count_ == kPacket) flush(seen);
  }

  template <typename Seen>
  void flush(const Seen& seen) {
    alignas(64) int valid[kPacket];
    for (int lane = 0; lane < kPacket; ++lane) valid[lane] = lane < count_ ? -1 : 0;
    // Where Embree has no packets of sixteen, it looks at the rays' intervals instead of `valid`.
    std::fill(packet_.tfar + count_, packet_.tfar + kPacket, -1.0F);
    if (count_ > 0) rays_.occlude(valid, packet_);
    for (int lane = 0; lane < count_; ++lane)
      seen(*shades_[static_cast<std::size_t>(lane)], packet_.tfar[lane] >= 0.0F);
    count_ = 0;
  }

 private:
  const Rays& rays_;
  RTCRay16 packet_{};  ///< numbers in unused rays too, since Embree may check them
  std::array<const Shade*, kPacket> shades_{};
  int count_ = 0;
};

}  // namespace

struct Square {
  int left;
  int top;
  int width;
  int height;
  std::vector<PixelSums> pixels;
  std::vector<Shade> shades;

  int pixel(std::size_t sample, int samples) const { return static_cast<int>(sample) / samples; }
};

Tracer::Tracer(const Scene& scene, const RenderOptions& options, const Triangles& triangles, const Rays& rays,
               const Camera& camera)
    : triangles_(triangles),
      rays_(rays),
      camera_(camera),
      lamps_(camera),
      width_(options.width),
      height_(options.height),
      samples_(options.samples * options.samples),
      has_ground_(options.ground == Ground::Shadow && triangles.count() > 0 &&
                  camera.eye.dot(camera.world_up) > camera.ground_height),
      zebra_(options.shading == Shading::Zebra),
      surface_color_(to_vec(scene.surface_color)),
      back_color_(to_vec(scene.back_color)),
      marker_color_(to_vec(scene.marker_color)),
      line_color_(to_vec(scene.line_color)) {
  for (const double value : scene.marker_scalars)
    marker_levels_.push_back(static_cast<float>(scene.scale.position(value)));
  if (!triangles.levels.empty() || !marker_levels_.empty()) {
    for (int i = 0; i < kLevelColors; ++i)
      level_colors_.push_back(to_vec(map_color(scene.scale.map, i / (kLevelColors - 1.0))));
    level_colors_.push_back(to_vec(map_color(scene.scale.map, std::numeric_limits<double>::quiet_NaN())));
  }
  // A rotated grid, in which no two samples share a row or a column of the pixel.
  const float n = static_cast<float>(options.samples);
  for (int j = 0; j < options.samples; ++j) {
    for (int i = 0; i < options.samples; ++i) {
      const auto x = static_cast<float>(i);
      const auto y = static_cast<float>(j);
      offsets_.emplace_back((x + (y + 0.5F) / n) / n, (y + (n - x - 0.5F) / n) / n);
    }
  }
  const int rows = kBlock * kBlock * samples_;
  for (int i = 0; i < rows; ++i) {
    const float half = 0.5F / static_cast<float>(rows);
    pattern_.emplace_back(spread_point(static_cast<std::uint32_t>(i)) + Eigen::Vector2f(half, half));
    key_directions_.push_back(lamps_.key_direction(pattern_.back().x(), pattern_.back().y()));
  }
}

Vec Tracer::direction(float x, float y) const {
  const float across = (2.0F * x / static_cast<float>(width_) - 1.0F) * camera_.tangent_x;
  const float up = (1.0F - 2.0F * y / static_cast<float>(height_)) * camera_.tangent_y;
  return (camera_.forward + across * camera_.right + up * camera_.up).normalized();
}

void Tracer::trace_square(int left, int top, Layers& layers) const {
  Square square;
  square.left = left;
  square.top = top;
  square.width = std::min(kSquare, width_ - left);
  square.height = std::min(kSquare, height_ - top);
  square.pixels.resize(static_cast<std::size_t>(square.width) * static_cast<std::size_t>(square.height));
  trace_eye_rays(square);
  trace_light_rays(square);
  for (int y = 0; y < square.height; ++y) {
    for (int x = 0; x < square.width; ++x) {
      PixelSums& sums = square.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(square.width) +
                                      static_cast<std::size_t>(x)];
      const float count = sums[Plane::Coverage];
      const float lit = sums[Plane::KeyWeight];
      const float ground = sums[Plane::GroundWeight];
      const auto mean = [](float sum, float weight) { return weight > 0.0F ? sum / weight : 0.0F; };
      sums[Plane::KeySeen] = mean(sums[Plane::KeySeen], lit);
      sums[Plane::KeyWeight] = mean(lit, count);
      sums[Plane::GroundKeySeen] = mean(sums[Plane::GroundKeySeen], ground);
      sums[Plane::GroundSkySeen] = mean(sums[Plane::GroundSkySeen], ground);
      for (std::size_t p = static_cast<std::size_t>(Plane::NormalX); p <= static_cast<std::size_t>(Plane::AmbientBlue);
           ++p)
        sums.sums[p] = mean(sums.sums[p], count);
      sums[Plane::SkySeen] = mean(sums[Plane::SkySeen], count);
      sums[Plane::Coverage] = count / static_cast<float>(samples_);
      sums[Plane::GroundWeight] = ground / static_cast<float>(samples_);
      const std::size_t at =
          static_cast<std::size_t>(top + y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(left + x);
      for (std::size_t p = 0; p < kPlaneCount; ++p) layers.planes[p][at] = sums.sums[p];
    }
  }
}

void Tracer::trace_eye_rays(Square& square) const {
  const std::size_t count = square.pixels.size() * static_cast<std::size_t>(samples_);
  RTCRayHit16 rays;
  std::array<Vec, kPacket> towards;
  alignas(64) int valid[kPacket];
  for (std::size_t begin = 0; begin < count; begin += kPacket) {
    for (int lane = 0; lane < kPacket; ++lane) {
      const std::size_t sample = std::min(begin + static_cast<std::size_t>(lane), count - 1);
      valid[lane] = begin + static_cast<std::size_t>(lane) < count ? -1 : 0;
      const int pixel = square.pixel(sample, samples_);
      const Eigen::Vector2f& offset = offsets_[sample % static_cast<std::size_t>(samples_)];
      const int column = square.left + pixel % square.width;
      const int row = square.top + pixel / square.width;
      towards[static_cast<std::size_t>(lane)] =
          direction(static_cast<float>(column) + offset.x(), static_cast<float>(row) + offset.y());
      const Vec& way = towards[static_cast<std::size_t>(lane)];
      rays.ray.org_x[lane] = camera_.eye.x();
      rays.ray.org_y[lane] = camera_.eye.y();
      rays.ray.org_z[lane] = camera_.eye.z();
      rays.ray.dir_x[lane] = way.x();
      rays.ray.dir_y[lane] = way.y();
      rays.ray.dir_z[lane] = way.z();
      rays.ray.tnear[lane] = 0.0F;
      rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      rays.ray.time[lane] = 0.0F;
      rays.ray.mask[lane] = ~0U;
      rays.ray.flags[lane] = 0;
    }
    rays_.intersect(valid, rays);
    for (int lane = 0; lane < kPacket && valid[lane] != 0; ++lane) {
      const std::size_t sample = begin + static_cast<std::size_t>(lane);
      if (rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
        take_hit(square, sample, towards[static_cast<std::size_t>(lane)], rays, lane);
      } else if (has_ground_) {
        take_ground(square, sample, towards[static_cast<std::size_t>(lane)]);
      }
    }
  }
}

void Tracer::take_hit(Square& square, std::size_t sample, const Vec& towards, const RTCRayHit16& rays, int lane) const {
  const auto part = static_cast<Part>(rays.hit.geomID[lane]);
  const Surfel surfel =
      part == Part::Surface
          ? surface_surfel(rays.hit.primID[lane], rays.hit.u[lane], rays.hit.v[lane], towards)
          : overlay_surfel(part, rays.hit.primID[lane], camera_.eye + rays.ray.tfar[lane] * towards,
                           Vec(rays.hit.Ng_x[lane], rays.hit.Ng_y[lane], rays.hit.Ng_z[lane]).normalized());
  const int pixel = square.pixel(sample, samples_);
  const Light light = reflect(lamps_, surfel, towards);
  PixelSums& sums = square.pixels[static_cast<std::size_t>(pixel)];
  sums[Plane::Coverage] += 1.0F;
  sums.add(Plane::NormalX, surfel.normal);
  sums.add(Plane::PositionX, surfel.position);
  sums.add(Plane::KeyRed, light.key);
  sums.add(Plane::AmbientRed, light.ambient);
  square.shades.push_back({surfel.origin, surfel.normal, surfel.geometric, pixel, pattern_row(square, sample), -1.0F});
}

void Tracer::take_ground(Square& square, std::size_t sample, const Vec& towards) const {
  const float fall = -towards.dot(camera_.world_up);
  if (fall <= 1e-4F) return;
  const float distance = (camera_.eye.dot(camera_.world_up) - camera_.ground_height) / fall;
  const Vec position = camera_.eye + distance * towards;
  const int pixel = square.pixel(sample, samples_);
  const float share = ground_share((position - camera_.ground_height * camera_.world_up).norm()) *
                      frame_share(square.left + pixel % square.width, square.top + pixel / square.width);
  if (share <= 0.0F) return;
  square.pixels[static_cast<std::size_t>(pixel)][Plane::GroundWeight] += 1.0F;
  square.shades.push_back({position, camera_.world_up, camera_.world_up, pixel, pattern_row(square, sample), share});
}

float Tracer::frame_share(int x, int y) const {
  const int inside = std::min(std::min(x, width_ - 1 - x), std::min(y, height_ - 1 - y)) - kFrame;
  const float t =
      std::clamp(static_cast<float>(inside) / (0.12F * static_cast<float>(std::min(width_, height_))), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

int Tracer::pattern_row(const Square& square, std::size_t sample) const {
  const int pixel = square.pixel(sample, samples_);
  const int place = block_place(square.left + pixel % square.width, square.top + pixel / square.width);
  return place * samples_ + static_cast<int>(sample) % samples_;
}

void Tracer::trace_light_rays(Square& square) const {
  // Points with the same row of the pattern send their rays in the same direction. Packets of such points are coherent.
  std::vector<int> offsets(pattern_.size() + 1, 0);
  for (const Shade& shade : square.shades) ++offsets[static_cast<std::size_t>(shade.pattern) + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<const Shade*> order(square.shades.size());
  for (const Shade& shade : square.shades)
    order[static_cast<std::size_t>(offsets[static_cast<std::size_t>(shade.pattern)]++)] = &shade;
  LightPacket packet(rays_);
  const auto key_seen = [&](const Shade& shade, bool seen) {
    PixelSums& sums = square.pixels[static_cast<std::size_t>(shade.pixel)];
    if (shade.ground_share >= 0.0F) {
      sums[Plane::GroundKeySeen] += seen ? 1.0F : 1.0F - shade.ground_share;
    } else {
      sums[Plane::KeySeen] += seen ? 1.0F : 0.0F;
      sums[Plane::KeyWeight] += 1.0F;
    }
  };
  for (const Shade* shade : order) {
    const Vec& towards = key_directions_[static_cast<std::size_t>(shade->pattern)];
    if (towards.dot(shade->normal) > 0.0F) packet.add(*shade, towards, kEverywhere, key_seen);
  }
  packet.flush(key_seen);
  const auto sky_seen = [&](const Shade& shade, bool seen) {
    PixelSums& sums = square.pixels[static_cast<std::size_t>(shade.pixel)];
    if (shade.ground_share >= 0.0F) {
      sums[Plane::GroundSkySeen] += seen ? 1.0F : 1.0F - shade.ground_share;
    } else {
      sums[Plane::SkySeen] += seen ? 1.0F : 0.0F;
    }
  };
  for (const Shade* shade : order) {
    const Eigen::Vector2f& point = pattern_[static_cast<std::size_t>(shade->pattern)];
    Vec towards = sky_direction(shade->normal, point.x(), point.y());
    // Below the facet's plane there is only the facet, so the ray is mirrored to the outside.
    const float inside = std::min(0.0F, towards.dot(shade->geometric));
    towards -= 2.0F * inside * shade->geometric;
    packet.add(*shade, towards, shade->ground_share >= 0.0F ? kGroundSkyReach : kSkyReach, sky_seen);
  }
  packet.flush(sky_seen);
}

Surfel Tracer::surface_surfel(unsigned triangle, float u, float v, const Vec& towards) const {
  const std::size_t corner = 3 * static_cast<std::size_t>(triangle);
  const Vec weights(1.0F - u - v, u, v);
  std::array<Vec, 3> corners;
  std::array<Vec, 3> normals;
  Surfel surfel;
  float level = 0.0F;
  surfel.position = Vec::Zero();
  surfel.normal = Vec::Zero();
  surfel.albedo = triangles_.colors.empty() ? surface_color_ : Vec(Vec::Zero());
  for (std::size_t i = 0; i < 3; ++i) {
    const float weight = weights[static_cast<Eigen::Index>(i)];
    const std::uint32_t vertex = triangles_.vertices[corner + i];
    corners[i] = triangles_.points[vertex];
    normals[i] = triangles_.normals[triangles_.normal_row(corner + i)];
    surfel.position += weight * corners[i];
    surfel.normal += weight * normals[i];
    if (!triangles_.colors.empty()) surfel.albedo += weight * triangles_.colors[vertex];
    if (!triangles_.levels.empty()) level += weight * triangles_.levels[vertex];
  }
  if (!triangles_.levels.empty()) {
    surfel.albedo = kDataAlbedo * level_color(level);
    surfel.gloss = kDataGloss;
  }
  surfel.geometric = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  const float facing = surfel.geometric.dot(towards) > 0.0F ? -1.0F : 1.0F;
  if (facing < 0.0F) surfel.albedo = back_color_;
  surfel.geometric *= facing;
  const float length = surfel.normal.norm();
  surfel.normal = length > 0.0F ? Vec(surfel.normal / length) : surfel.geometric;
  // The given normals may point either way.
  const float side = surfel.normal.dot(surfel.geometric) < 0.0F ? -1.0F : 1.0F;
  surfel.normal *= side;
  if (zebra_) surfel.albedo = zebra_albedo(lamps_, surfel.normal, towards);
  for (Vec& normal : normals) normal *= normal.dot(surfel.geometric) < 0.0F ? -1.0F : 1.0F;
  surfel.origin = round_origin(surfel.position, corners, normals, weights);
  return surfel;
}

Vec Tracer::level_color(float level) const {
  if (std::isnan(level)) return level_colors_.back();
  const int place = std::clamp(static_cast<int>(std::lround(level * (kLevelColors - 1))), 0, kLevelColors - 1);
  return level_colors_[static_cast<std::size_t>(place)];
}

Surfel Tracer::overlay_surfel(Part part, unsigned number, const Vec& position, const Vec& normal) const {
  if (part == Part::Markers && !marker_levels_.empty())
    return {position, position, normal, normal, kDataAlbedo * level_color(marker_levels_[number]), kDataGloss};
  return {position, position, normal, normal, part == Part::Markers ? marker_color_ : line_color_};
}

}  // namespace batten::render_detail
