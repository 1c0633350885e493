#include "batten/render/rays.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "batten/error.h"

namespace batten::render_detail {
namespace {

constexpr std::size_t kMostMarkers = 20000;
constexpr std::size_t kMostLines = 60000;

/// The edges as (lower, higher), without repetitions.
std::vector<std::pair<Index, Index>> unique_edges(const Mesh& mesh) {
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(mesh.face_vertices.size());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* v = mesh.face_vertices.data() + mesh.face_offsets[f];
    const Index size = mesh.face_size(f);
    for (Index c = 0; c < size; ++c) edges.push_back(std::minmax(v[c], v[(c + 1) % size]));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// A radius in the frame's unit, where the shape's diagonal is 2: a share of the mean distance between `count` points
/// on it.
float automatic_radius(std::size_t count, float share, float most) {
  const float spacing = 1.3F / std::sqrt(static_cast<float>(std::max<std::size_t>(count, 1)));
  return std::min(share * spacing, 2.0F * most);
}

/// Throws Error(BadArgument) for a radius that is negative or not finite.
float asked_radius(double radius, const Frame& frame, const char* what) {
  if (!(radius >= 0.0) || !std::isfinite(radius * frame.scale))
    throw Error(ErrorCode::BadArgument, std::string("the radius of the ") + what + " must be finite and not negative");
  return static_cast<float>(radius * frame.scale);
}

void check_device(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(ErrorCode::NotAvailable, "Embree cannot run here (its error " + std::to_string(error) + ")");
}

void attach(RTCScene scene, RTCGeometry geometry, Part part) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(part));
  rtcReleaseGeometry(geometry);
}

}  // namespace

Overlay overlay_of(const Scene& scene, const Frame& frame, const RenderOptions& options) {
  Overlay overlay;
  const auto markers = static_cast<std::size_t>(scene.markers.rows());
  float radius = asked_radius(options.marker_radius, frame, "markers");
  if (radius > 0.0F || markers <= kMostMarkers) {
    if (radius == 0.0F) radius = automatic_radius(markers, 0.14F, 0.005F);
    overlay.markers.resize(markers);
    for (std::size_t i = 0; i < markers; ++i)
      overlay.markers[i] = {frame.apply(scene.markers.row(static_cast<Eigen::Index>(i))), radius};
  }
  radius = asked_radius(options.line_radius, frame, "lines");
  const auto edges = unique_edges(scene.lines);
  if (radius > 0.0F || edges.size() <= kMostLines) {
    if (radius == 0.0F) radius = automatic_radius(edges.size() / 2, 0.04F, 0.0012F);
    overlay.tubes.reserve(2 * edges.size());
    for (const auto& edge : edges) {
      overlay.tubes.push_back({frame.apply(scene.lines.points.row(edge.first)), radius});
      overlay.tubes.push_back({frame.apply(scene.lines.points.row(edge.second)), radius});
    }
  }
  return overlay;
}

Rays::Rays(const Triangles& triangles, const Overlay& overlay) : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw Error(ErrorCode::NotAvailable, "Embree cannot start on this machine");
  surface_.reset(rtcNewScene(device_.get()));
  overlay_.reset(rtcNewScene(device_.get()));
  // Without this flag a ray may pass between two triangles and leave a light dot.
  rtcSetSceneFlags(surface_.get(), RTC_SCENE_FLAG_ROBUST);
  has_surface_ = triangles.count() > 0;
  has_overlay_ = !overlay.markers.empty() || !overlay.tubes.empty();
  if (has_surface_) {
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, triangles.points.data(), 0,
                               sizeof(Vec), triangles.points.size() - 1);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.vertices.data(), 0,
                               3 * sizeof(std::uint32_t), triangles.count());
    attach(surface_.get(), mesh, Part::Surface);
  }
  if (!overlay.markers.empty()) {
    RTCGeometry markers = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(markers, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, overlay.markers.data(), 0,
                               sizeof(Ball), overlay.markers.size());
    attach(overlay_.get(), markers, Part::Markers);
  }
  if (!overlay.tubes.empty()) {
    tube_starts_.resize(overlay.tubes.size() / 2);
    for (std::size_t i = 0; i < tube_starts_.size(); ++i) tube_starts_[i] = static_cast<std::uint32_t>(2 * i);
    RTCGeometry tubes = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    rtcSetSharedGeometryBuffer(tubes, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, overlay.tubes.data(), 0,
                               sizeof(Ball), overlay.tubes.size());
    rtcSetSharedGeometryBuffer(tubes, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, tube_starts_.data(), 0,
                               sizeof(std::uint32_t), tube_starts_.size());
    attach(overlay_.get(), tubes, Part::Lines);
  }
  rtcCommitScene(surface_.get());
  rtcCommitScene(overlay_.get());
  check_device(device_.get());
}

void Rays::intersect(const int* valid, RTCRayHit16& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::fill(rays.hit.geomID, rays.hit.geomID + kPacket, RTC_INVALID_GEOMETRY_ID);
  // The second scene only counts where it is nearer, because tfar is the first scene's distance.
  if (has_surface_) rtcIntersect16(valid, surface_.get(), &context, &rays);
  if (has_overlay_) rtcIntersect16(valid, overlay_.get(), &context, &rays);
}

void Rays::occlude(const int* valid, RTCRay16& rays) const {
  if (!has_surface_) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, surface_.get(), &context, &rays);
}

}  // namespace batten::render_detail
