#include "batten/render/tracer.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten::render_detail {
namespace {

constexpr float kLift = 2e-4F;     // the distance from the surface at which shadow rays start
constexpr float kSkyReach = 0.9F;  // objects beyond this distance do not block the sky
constexpr float kGroundSkyReach = 0.6F;
constexpr int kFrame = 8;  // pixels at the picture's edge that are exactly the background, whatever the smoothing does
constexpr float kFade = 0.2F;  // the share of the picture over which shadows on the ground fade towards its edge
constexpr float kEverywhere = 100.0F;  // beyond everything inside or near the unit sphere

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

Tracer::Tracer(const Eye& eye, const RenderOptions& options, const Rays& rays, const Overlay& overlay,
               const Lamps& lamps, const Paint& paint)
    : eye_(eye),
      rays_(rays),
      overlay_(overlay),
      lamps_(lamps),
      paint_(paint),
      samples_(options.samples * options.samples),
      has_ground_(options.ground == Ground::Shadow && rays.has_surface() &&
                  eye.camera.eye.dot(eye.camera.world_up) > eye.camera.ground_height) {
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

void Tracer::trace(Layers& layers, const Progress& progress) const {
  const int across = (eye_.width + kSquare - 1) / kSquare;
  const int down = (eye_.height + kSquare - 1) / kSquare;
  for (int row = 0; row < down; ++row) {
    if (progress && !progress(static_cast<double>(row) / down))
      throw Error(ErrorCode::Cancelled, "the picture was cancelled");
    parallel_for_each(across, [&](std::ptrdiff_t column) {
      trace_square(static_cast<int>(column) * kSquare, row * kSquare, layers);
    });
  }
}

void Tracer::trace_square(int left, int top, Layers& layers) const {
  Square square;
  square.left = left;
  square.top = top;
  square.width = std::min(kSquare, eye_.width - left);
  square.height = std::min(kSquare, eye_.height - top);
  square.pixels.resize(static_cast<std::size_t>(square.width) * static_cast<std::size_t>(square.height));
  trace_eye_rays(square);
  trace_light_rays(square);
  for (int y = 0; y < square.height; ++y) {
    for (int x = 0; x < square.width; ++x) {
      PixelSums& sums = square.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(square.width) +
                                      static_cast<std::size_t>(x)];
      const float count = sums[Plane::Solid];
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
      const auto samples = static_cast<float>(samples_);
      for (const Plane plane : {Plane::Coverage, Plane::Solid, Plane::GlowRed, Plane::GlowGreen, Plane::GlowBlue})
        sums[plane] /= samples;
      sums[Plane::GroundWeight] = ground / samples;
      const std::size_t at =
          static_cast<std::size_t>(top + y) * static_cast<std::size_t>(eye_.width) + static_cast<std::size_t>(left + x);
      for (std::size_t p = 0; p < kPlaneCount; ++p) layers.planes[p][at] = sums.sums[p];
    }
  }
}

void Tracer::trace_eye_rays(Square& square) const {
  const std::size_t count = square.pixels.size() * static_cast<std::size_t>(samples_);
  RTCRayHit16 to_surface;
  RTCRayHit16 to_overlay;
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
      Vec& way = towards[static_cast<std::size_t>(lane)];
      way = eye_.direction(static_cast<float>(column) + offset.x(), static_cast<float>(row) + offset.y());
      eye_.aim(to_surface, lane, way);
    }
    if (rays_.has_overlay()) to_overlay = to_surface;
    rays_.meet_surface(valid, to_surface);
    if (rays_.has_overlay()) rays_.meet_overlay(valid, to_overlay);
    for (int lane = 0; lane < kPacket && valid[lane] != 0; ++lane) {
      const std::size_t sample = begin + static_cast<std::size_t>(lane);
      const Vec& way = towards[static_cast<std::size_t>(lane)];
      const float left = rays_.has_overlay() ? take_overlay(square, sample, to_overlay, to_surface, lane) : 1.0F;
      if (to_surface.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
        take_surface(square, sample, way, to_surface, lane, left);
      } else if (has_ground_ && left == 1.0F) {
        take_ground(square, sample, way);
      }
    }
  }
}

float Tracer::take_overlay(Square& square, std::size_t sample, const RTCRayHit16& overlay, const RTCRayHit16& surface,
                           int lane) const {
  if (overlay.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return 1.0F;
  const auto part = static_cast<Part>(overlay.hit.geomID[lane]);
  const bool over_surface = surface.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
  const float behind = overlay.ray.tfar[lane] - surface.ray.tfar[lane];
  const float opacity = over_surface ? overlay_opacity(part, behind, overlay_.radius(part)) : 1.0F;
  PixelSums& sums = square.pixels[static_cast<std::size_t>(square.pixel(sample, samples_))];
  sums.add(Plane::GlowRed, opacity * paint_.overlay_color(overlay_, part, overlay.hit.primID[lane]));
  if (!over_surface) sums[Plane::Coverage] += 1.0F;
  return 1.0F - opacity;
}

void Tracer::take_surface(Square& square, std::size_t sample, const Vec& towards, const RTCRayHit16& rays, int lane,
                          float left) const {
  const unsigned triangle = rays.hit.primID[lane];
  const Surfel surfel = paint_.surfel(triangle, rays.hit.u[lane], rays.hit.v[lane], towards);
  const Shine shine = paint_.shine(surfel, triangle, rays.hit.u[lane], rays.hit.v[lane], towards);
  const int pixel = square.pixel(sample, samples_);
  PixelSums& sums = square.pixels[static_cast<std::size_t>(pixel)];
  sums[Plane::Coverage] += 1.0F;
  sums[Plane::Solid] += 1.0F;
  sums.add(Plane::NormalX, surfel.normal);
  sums.add(Plane::PositionX, surfel.position);
  sums.add(Plane::KeyRed, left * shine.lit.key);
  sums.add(Plane::AmbientRed, left * shine.lit.ambient);
  sums.add(Plane::GlowRed, left * shine.glow);
  square.shades.push_back({surfel.origin, surfel.normal, surfel.geometric, pixel, pattern_row(square, sample), -1.0F});
}

void Tracer::take_ground(Square& square, std::size_t sample, const Vec& towards) const {
  const float fall = -towards.dot(eye_.camera.world_up);
  if (fall <= 1e-4F) return;
  const float distance = (eye_.camera.eye.dot(eye_.camera.world_up) - eye_.camera.ground_height) / fall;
  const Vec position = eye_.camera.eye + distance * towards;
  const int pixel = square.pixel(sample, samples_);
  const float share = ground_share((position - eye_.camera.ground_height * eye_.camera.world_up).norm()) *
                      frame_share(square.left + pixel % square.width, square.top + pixel / square.width);
  if (share <= 0.0F) return;
  square.pixels[static_cast<std::size_t>(pixel)][Plane::GroundWeight] += 1.0F;
  square.shades.push_back(
      {position, eye_.camera.world_up, eye_.camera.world_up, pixel, pattern_row(square, sample), share});
}

float Tracer::frame_share(int x, int y) const {
  // The product over both directions has round corners, and no edge of a rectangle shows in the shadow.
  const auto share = [](int place, int size) {
    const auto inside = static_cast<float>(std::min(place, size - 1 - place) - kFrame);
    const float t = std::clamp(inside / (kFade * static_cast<float>(size)), 0.0F, 1.0F);
    return t * t * t * (t * (6.0F * t - 15.0F) + 10.0F);
  };
  return share(x, eye_.width) * share(y, eye_.height);
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

}  // namespace batten::render_detail
