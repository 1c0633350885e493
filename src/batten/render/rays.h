/// \file The scene in Embree: packets of sixteen rays against the surface, the markers and the lines.
#pragma once
#include <embree3/rtcore.h>

#include <memory>

#include "batten/render/geometry.h"

namespace batten::render_detail {

/// Centre and radius, in the frame's unit. Two consecutive ones are the ends of a tube.
struct Ball {
  Vec centre;
  float radius;
};

enum class Part : unsigned { Surface = 0, Markers = 1, Lines = 2 };

/// What is drawn with the surface.
struct Overlay {
  float marker_radius = 0.0F;
  float line_radius = 0.0F;
  Buffer<Ball> markers;
  Buffer<Ball> tubes;
  Buffer<float> line_levels;  ///< a position on the colour scale for each tube (NaN: the line's colour), or empty

  bool empty() const { return markers.empty() && tubes.empty(); }
  float radius(Part part) const { return part == Part::Lines ? line_radius : marker_radius; }
};

inline constexpr int kPacket = 16;

/// Refers to the triangles and to the buffers of the overlay, which must outlive it.
class Rays {
 public:
  explicit Rays(const Triangles& triangles);

  /// Replaces the overlay.
  void show(const Overlay& overlay);

  bool has_surface() const { return has_surface_; }
  bool has_overlay() const { return has_overlay_; }

  /// Finds the nearest hit for each lane whose `valid` is -1. geomID is then a Part, or RTC_INVALID_GEOMETRY_ID.
  void meet_surface(const int* valid, RTCRayHit16& rays) const;
  void meet_overlay(const int* valid, RTCRayHit16& rays) const;

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
