#include "batten/render/overlay.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/render/light.h"

namespace batten::render_detail {
namespace {

constexpr float kThinnest = 0.9F;  // pixels
constexpr float kSmallest = 1.0F;
constexpr double kMostShare = 0.2;
// Lines whose lengths times their width are so many pictures hide the surface in any case, and need no rays.
constexpr double kHopeless = 8.0;

struct Segment {
  Index a;
  Index b;
  Index face;
};

/// The edges without repetitions, each with the first of its faces.
std::vector<Segment> unique_edges(const Mesh& mesh) {
  std::vector<Segment> edges;
  edges.reserve(mesh.face_vertices.size());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* v = mesh.face_vertices.data() + mesh.face_offsets[f];
    const Index size = mesh.face_size(f);
    for (Index c = 0; c < size; ++c) {
      const auto ends = std::minmax(v[c], v[(c + 1) % size]);
      edges.push_back({ends.first, ends.second, f});
    }
  }
  const auto before = [](const Segment& s, const Segment& t) {
    return s.a != t.a ? s.a < t.a : s.b != t.b ? s.b < t.b : s.face < t.face;
  };
  const auto same = [](const Segment& s, const Segment& t) { return s.a == t.a && s.b == t.b; };
  std::sort(edges.begin(), edges.end(), before);
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  return edges;
}

float asked_radius(double radius, const Frame& frame, const char* what) {
  if (!(radius >= 0.0) || !std::isfinite(radius * frame.scale))
    throw Error(ErrorCode::BadArgument, std::string("the radius of the ") + what + " must be finite and not negative");
  return static_cast<float>(radius * frame.scale);
}

/// The lines' area in pictures, if all could be seen.
double lines_area(const Overlay& overlay, const Eye& eye) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < overlay.tubes.size(); i += 2)
    length += double{(overlay.tubes[i + 1].centre - overlay.tubes[i].centre).norm()};
  const double pixel = eye.pixel_size();
  return length * kThinnest / pixel / (double{1} * eye.width * eye.height);
}

/// How many times thinner something has to be that covers a share, where places overlap at random.
double thinner(double share) { return std::log1p(-kMostShare) / std::log1p(-std::min(share, 0.999)); }

/// The lines or the markers, and what becomes of them.
struct Kind {
  const char* name;
  bool fixed;        ///< the options give the radius
  bool has_numbers;  ///< these are what the picture shows, so they are never left out
  bool is_left_out = false;

  void leave_out(double share, std::vector<std::string>* notes) {
    is_left_out = true;
    if (notes == nullptr) return;
    const std::string percent = std::to_string(static_cast<int>(std::lround(100.0 * share)));
    notes->push_back("the " + std::string(name) + " are not drawn: they would cover " + percent + " % of the surface");
  }

  /// Makes the size smaller if the kind covers too much.
  void fit(double share, double factor, float least, float& size, std::vector<std::string>* notes) {
    if (fixed || is_left_out || share <= kMostShare) return;
    const float wanted = size * static_cast<float>(factor);
    if (wanted < least && !has_numbers) leave_out(share, notes);
    size = std::max(wanted, least);
  }
};

}  // namespace

OverlaySizes standard_sizes(const Scene& scene, int width, int height) {
  const auto side = static_cast<float>(std::min(width, height));
  OverlaySizes sizes{std::max(1.2F, side / 550.0F), std::max(1.9F, side / 250.0F)};
  if (scene.line_scalars.size() > 0) sizes.line_width *= 2.0F;
  if (scene.marker_scalars.size() > 0) sizes.marker_radius *= 1.6F;
  return sizes;
}

Overlay overlay_of(const Scene& scene, const Frame& frame, const RenderOptions& options, const Eye& eye,
                   const OverlaySizes& sizes) {
  Overlay overlay;
  overlay.marker_radius = asked_radius(options.marker_radius, frame, "markers");
  if (overlay.marker_radius == 0.0F) overlay.marker_radius = sizes.marker_radius * eye.pixel_size();
  overlay.line_radius = asked_radius(options.line_radius, frame, "lines");
  if (overlay.line_radius == 0.0F) overlay.line_radius = 0.5F * sizes.line_width * eye.pixel_size();
  overlay.markers.resize(static_cast<std::size_t>(scene.markers.rows()));
  for (std::size_t i = 0; i < overlay.markers.size(); ++i)
    overlay.markers[i] = {frame.apply(scene.markers.row(static_cast<Eigen::Index>(i))), overlay.marker_radius};
  const std::vector<Segment> edges = unique_edges(scene.lines);
  overlay.tubes.reserve(2 * edges.size());
  for (const Segment& edge : edges) {
    for (const Index end : {edge.a, edge.b})
      overlay.tubes.push_back({frame.apply(scene.lines.points.row(end)), overlay.line_radius});
    if (scene.line_scalars.size() > 0)
      overlay.line_levels.push_back(static_cast<float>(scene.scale.position(scene.line_scalars[edge.face])));
  }
  return overlay;
}

OverlayShares measure_overlay(const Rays& rays, const Overlay& overlay, const Eye& eye) {
  struct Counts {
    std::int64_t surface = 0;
    std::int64_t lines = 0;
    std::int64_t markers = 0;
  };
  constexpr std::ptrdiff_t kPackets = 65536 / kPacket;
  const auto count_packets = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Counts counts;
    alignas(64) int valid[kPacket];
    std::fill(valid, valid + kPacket, -1);
    RTCRayHit16 rays_to_surface;
    for (std::ptrdiff_t packet = begin; packet < end; ++packet) {
      for (int lane = 0; lane < kPacket; ++lane) {
        const Eigen::Vector2f place = spread_point(static_cast<std::uint32_t>(packet * kPacket + lane));
        eye.aim(rays_to_surface, lane,
                eye.direction(place.x() * static_cast<float>(eye.width), place.y() * static_cast<float>(eye.height)));
      }
      RTCRayHit16 rays_to_overlay = rays_to_surface;
      rays.meet_surface(valid, rays_to_surface);
      rays.meet_overlay(valid, rays_to_overlay);
      for (int lane = 0; lane < kPacket; ++lane) {
        if (rays_to_surface.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        ++counts.surface;
        if (rays_to_overlay.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        const auto part = static_cast<Part>(rays_to_overlay.hit.geomID[lane]);
        const float behind = rays_to_overlay.ray.tfar[lane] - rays_to_surface.ray.tfar[lane];
        if (overlay_opacity(part, behind, overlay.radius(part)) < 0.5F) continue;
        ++(part == Part::Lines ? counts.lines : counts.markers);
      }
    }
    return counts;
  };
  const Counts counts = parallel_reduce<Counts>(
      kPackets, Counts(), count_packets,
      [](const Counts& a, const Counts& b) {
        return Counts{a.surface + b.surface, a.lines + b.lines, a.markers + b.markers};
      },
      256);
  const auto surface = static_cast<double>(std::max<std::int64_t>(counts.surface, 1));
  return {static_cast<double>(counts.lines) / surface, static_cast<double>(counts.markers) / surface};
}

Overlay show_overlay(const Scene& scene, const Frame& frame, const RenderOptions& options, const Eye& eye, Rays& rays,
                     std::vector<std::string>* notes) {
  OverlaySizes sizes = standard_sizes(scene, eye.width, eye.height);
  Overlay overlay = overlay_of(scene, frame, options, eye, sizes);
  Kind lines{"lines", options.line_radius > 0.0, scene.line_scalars.size() > 0};
  Kind markers{"markers", options.marker_radius > 0.0, scene.marker_scalars.size() > 0};
  if (rays.has_surface() && !lines.fixed && !lines.has_numbers && lines_area(overlay, eye) > kHopeless) {
    lines.leave_out(1.0, notes);
    overlay.tubes.clear();
  }
  rays.show(overlay);
  if (!rays.has_surface() || (overlay.tubes.empty() && overlay.markers.empty())) return overlay;
  const OverlayShares shares = measure_overlay(rays, overlay, eye);
  if (std::max(lines.fixed ? 0.0 : shares.lines, markers.fixed ? 0.0 : shares.markers) <= kMostShare) return overlay;
  lines.fit(shares.lines, thinner(shares.lines), kThinnest, sizes.line_width, notes);
  markers.fit(shares.markers, std::sqrt(thinner(shares.markers)), kSmallest, sizes.marker_radius, notes);
  overlay = overlay_of(scene, frame, options, eye, sizes);
  if (lines.is_left_out) overlay.tubes.clear();
  if (markers.is_left_out) overlay.markers.clear();
  rays.show(overlay);
  return overlay;
}

float overlay_opacity(Part part, float behind, float radius) {
  const float depth = behind - 2.0F * radius;  // the thickness of a tube or a ball, and as much again
  if (depth <= 0.0F) return 1.0F;
  constexpr float kFade = 2.0F;  // radii over which the full colour ends, so that no line ends in a thorn
  const float t = std::min(depth / (kFade * radius), 1.0F);
  const float sharp = 1.0F - t * t * (3.0F - 2.0F * t);
  if (part == Part::Markers) return sharp;
  constexpr float kNearReach = 0.08F;
  const float faint = 0.09F + 0.30F * std::exp(-depth / kNearReach);
  return std::max(sharp, faint);
}

}  // namespace batten::render_detail
