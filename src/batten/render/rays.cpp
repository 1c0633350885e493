#include "batten/render/rays.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "batten/error.h"

namespace batten::render_detail {
namespace {

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

void meet(const int* valid, bool has_shapes, RTCScene scene, RTCRayHit16& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::fill(rays.hit.geomID, rays.hit.geomID + kPacket, RTC_INVALID_GEOMETRY_ID);
  if (has_shapes) rtcIntersect16(valid, scene, &context, &rays);
}

}  // namespace

Rays::Rays(const Triangles& triangles) : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw Error(ErrorCode::NotAvailable, "Embree cannot start on this machine");
  surface_.reset(rtcNewScene(device_.get()));
  // Without this flag a ray may pass between two triangles and leave a light dot.
  rtcSetSceneFlags(surface_.get(), RTC_SCENE_FLAG_ROBUST);
  has_surface_ = triangles.count() > 0;
  if (has_surface_) {
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, triangles.points.data(), 0,
                               sizeof(Vec), triangles.points.size() - 1);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.vertices.data(), 0,
                               3 * sizeof(std::uint32_t), triangles.count());
    attach(surface_.get(), mesh, Part::Surface);
  }
  rtcCommitScene(surface_.get());
  check_device(device_.get());
}

void Rays::show(const Overlay& overlay) {
  overlay_.reset(rtcNewScene(device_.get()));
  has_overlay_ = !overlay.empty();
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
  rtcCommitScene(overlay_.get());
  check_device(device_.get());
}

void Rays::meet_surface(const int* valid, RTCRayHit16& rays) const { meet(valid, has_surface_, surface_.get(), rays); }

void Rays::meet_overlay(const int* valid, RTCRayHit16& rays) const { meet(valid, has_overlay_, overlay_.get(), rays); }

void Rays::occlude(const int* valid, RTCRay16& rays) const {
  if (!has_surface_) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, surface_.get(), &context, &rays);
}

}  // namespace batten::render_detail
