/// \file The scene in Embree: packets of sixteen rays against the surface, the markers and the lines.
#pragma once
#include <embree3/rtcore.h>

#include <memory>

#include "batten/render/geometry.h"

namespace batten::render_detail {

/// Centre and radius. Two consecutive ones are the ends of a tube.
struct Ball {
  Vec centre;
  float radius;
};

struct Overlay {
  Buffer<Ball> markers;
  Buffer<Ball> tubes;
};

/// The markers and lines, with the radii that RenderOptions::marker_radius specifies.
Overlay overlay_of(const Scene& scene, const Frame& frame, const RenderOptions& options);

enum class Part : unsigned { Surface = 0, Markers = 1, Lines = 2 };

inline constexpr int kPacket = 16;

/// Refers to the triangles and the overlay, which must outlive it.
class Rays {
 public:
  Rays(const Triangles& triangles, const Overlay& overlay);

  /// Finds the nearest hit for each lane whose `valid` is -1. geomID is then a Part, or RTC_INVALID_GEOMETRY_ID.
  void intersect(const int* valid, RTCRayHit16& rays) const;

  /// Makes tfar negative where the surface blocks the ray before it.
  void occlude(const int* valid, RTCRay16& rays) const;

 private:
  template <typename Handle, void (*release)(Handle)>
  struct Release {
    using pointer = Handle;
    void operator()(Handle handle) const { release(handle); }
  };
  using Device = std::unique_ptr<RTCDevice, Release<RTCDevice, rtcReleaseDevice>>;
  using Bounds = std::unique_ptr<RTCScene, Release<RTCScene, rtcReleaseScene>>;

  Device device_;
  Bounds surface_;
  Bounds overlay_;
  Buffer<std::uint32_t> tube_starts_;
  bool has_surface_ = false;
  bool has_overlay_ = false;
};

}  // namespace batten::render_detail
