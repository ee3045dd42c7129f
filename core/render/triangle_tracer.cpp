// SPDX-License-Identifier: Apache-2.0
#include "core/render/triangle_tracer.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/error.h"

namespace beam {
namespace {

bool isFinite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void requireTriangles(const Mesh& mesh, std::size_t place) {
  const std::size_t count = mesh.vertices.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner < count) continue;
      throw Error(Error::Kind::Data,
                  fmt::format("mesh {}: triangle {} has the corner {}, expected less than its {} vertices",
                              place, i, corner, count));
    }
  }
  const auto odd = std::find_if_not(mesh.vertices.begin(), mesh.vertices.end(), isFinite);
  if (odd != mesh.vertices.end())
    throw Error(Error::Kind::Data,
                fmt::format("mesh {}: vertex {} is not finite", place, odd - mesh.vertices.begin()));
}

RTCRay rayOf(vec3 o, vec3 d, float reach_m) {
  RTCRay r{};
  r.org_x = o.x, r.org_y = o.y, r.org_z = o.z, r.dir_x = d.x, r.dir_y = d.y, r.dir_z = d.z;
  r.tfar = reach_m;
  r.mask = 0xffffffffu;
  return r;
}

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

}  // namespace

struct TriangleTracer::State {
  std::atomic<std::ptrdiff_t> bytes{0};  // outlives the device, which reports to it
  std::unique_ptr<RTCDeviceTy, Release> device;
  std::unique_ptr<RTCSceneTy, Release> scene;

  static bool countMemory(void* self, ssize_t bytes, bool) {
    static_cast<State*>(self)->bytes += bytes;
    return true;
  }

  // One thread and a fixed instruction set: the same tree, and of two triangles that a ray meets in one
  // place the same one, on every machine.
  explicit State(TriangleEdges edges) {
    device.reset(rtcNewDevice("threads=1,isa=avx2"));
    if (!device)
      throw Error(Error::Kind::Bug,
                  fmt::format("Embree did not start: code {}", static_cast<int>(rtcGetDeviceError(nullptr))));
    rtcSetDeviceMemoryMonitorFunction(device.get(), &State::countMemory, this);
    scene.reset(rtcNewScene(device.get()));
    if (edges == TriangleEdges::Closed) rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  }

  void add(const Mesh& mesh, unsigned place) {
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                          RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    if (v && t) {
      put(mesh.vertices, v);
      for (const auto& corners : mesh.triangles) t = std::copy_n(corners.data(), 3, t);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene.get(), geometry, place);
    }
    rtcReleaseGeometry(geometry);
    requireNoError();
  }

  static void put(std::span<const vec3> vertices, float* to) {
    for (const vec3& x : vertices) to = std::copy_n(&x[0], 3, to);
  }

  void requireNoError() const {
    const RTCError code = rtcGetDeviceError(device.get());
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(Error::Kind::OutOfMemory, "out of memory for rays among meshes; close other programs");
    throw Error(Error::Kind::Bug,
                fmt::format("Embree could not build over the meshes: code {}", static_cast<int>(code)));
  }
};

TriangleTracer::TriangleTracer(std::span<const Mesh> meshes, TriangleEdges edges)
    : state_(std::make_unique<State>(edges)) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    requireTriangles(meshes[i], i);
    if (!meshes[i].triangles.empty()) state_->add(meshes[i], static_cast<unsigned>(i));
  }
  rtcCommitScene(state_->scene.get());
  state_->requireNoError();
}
TriangleTracer::~TriangleTracer() = default;
TriangleTracer::TriangleTracer(TriangleTracer&&) noexcept = default;
TriangleTracer& TriangleTracer::operator=(TriangleTracer&&) noexcept = default;

void TriangleTracer::move(std::uint32_t mesh, std::span<const vec3> vertices) {
  const RTCGeometry geometry = rtcGetGeometry(state_->scene.get(), mesh);
  if (!geometry) return;  // no triangles
  State::put(vertices, static_cast<float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0)));
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
  rtcCommitScene(state_->scene.get());
  state_->requireNoError();
}

// Embree 4 has no context: these two calls lose theirs.
std::optional<TriangleHit> TriangleTracer::nearest(vec3 o, vec3 d, float reach_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit rh{};
  rh.ray = rayOf(o, d, reach_m);
  rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene.get(), &context, &rh);
  if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const vec3 across(rh.hit.Ng_x, rh.hit.Ng_y, rh.hit.Ng_z);
  const float length = glm::length(across);
  return TriangleHit{.mesh = rh.hit.geomID,
                     .triangle = rh.hit.primID,
                     .weights = {rh.hit.u, rh.hit.v},
                     .distance_m = rh.ray.tfar,
                     .normal = length > 0 ? across / length : -d};
}

bool TriangleTracer::occluded(vec3 o, vec3 d, float reach_m) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay r = rayOf(o, d, reach_m);
  rtcOccluded1(state_->scene.get(), &context, &r);
  return r.tfar < 0;
}

std::size_t TriangleTracer::memoryBytes() const { return static_cast<std::size_t>(state_->bytes.load()); }

}  // namespace beam
