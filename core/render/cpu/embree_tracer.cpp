// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/embree_tracer.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace beam {
namespace {

constexpr double kUnit = 1 << 20;  // of the fixed-point sum of alphas
constexpr std::size_t kRayGrain = 1024;

// A Gaussian as rays meet it: canonical(x) = m x - mc.
struct Particle {
  float m[9], mc[3];
  float opacity, cut2;  // squared radius of the cut in standard deviations
  vec3 low, high;       // box of the cut ellipsoid
};

Particle particleOf(const GaussianCloud& cloud, std::size_t i, float cut_response) {
  Particle p{};
  const mat3 r = glm::mat3_cast(cloud.rotation[i]);
  const vec3 s = glm::max(cloud.scale_m[i], vec3(1e-6f)), x = cloud.position_m[i];
  p.opacity = cloud.opacity[i];
  p.cut2 = p.opacity > cut_response ? 2 * std::log(p.opacity / cut_response) : 0;
  vec3 half(0);
  for (int k = 0; k < 3; ++k) {
    const vec3 axis = r[k];
    for (int c = 0; c < 3; ++c) {
      p.m[3 * k + c] = axis[c] / s[k];
      half[c] += axis[c] * axis[c] * s[k] * s[k];
    }
    p.mc[k] = glm::dot(axis, x) / s[k];
  }
  for (int c = 0; c < 3; ++c) half[c] = std::sqrt(half[c] * p.cut2) * 1.0001f;
  p.low = x - half;
  p.high = x + half;
  return p;
}

// opacity * response at the maximum along the ray, in fixed point; 0 outside the cut, behind the origin, or
// (when asked) where the cut ellipsoid holds the origin (methods 4.3).
std::uint64_t alphaAlong(const Particle& p, const Ray& ray, bool ignore_containing) {
  vec3 o, d;
  for (int k = 0; k < 3; ++k) {
    const vec3 row(p.m[3 * k], p.m[3 * k + 1], p.m[3 * k + 2]);
    o[k] = glm::dot(row, ray.origin) - p.mc[k];
    d[k] = glm::dot(row, ray.direction);
  }
  const float od = glm::dot(o, d);
  if (od >= 0) return 0;
  if (ignore_containing && glm::dot(o, o) < p.cut2) return 0;
  const vec3 across = glm::cross(o, d);  // |o x d|^2 / |d|^2: free of cancellation
  const float distance2 = glm::dot(across, across) / glm::dot(d, d);
  if (distance2 >= p.cut2) return 0;
  return static_cast<std::uint64_t>(p.opacity * std::exp(-0.5f * distance2) * kUnit + 0.5);
}

struct RayState : RTCIntersectContext {
  const Ray* ray;
  std::uint64_t sum, threshold;
};

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const TracerDesc& desc, const GaussianCloud& cloud)
      : desc_(desc), threshold_(static_cast<std::uint64_t>(std::llround(desc.threshold * kUnit))) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Particle p = particleOf(cloud, i, desc.cut_response);
      if (p.cut2 > 0) particles_.push_back(p);
    }
    // A fixed instruction set: traversal order must not depend on the machine, sums do not depend on the
    // order.
    device_ = rtcNewDevice("threads=1,isa=avx2");
    if (!device_)
      throw Error(Error::Kind::Bug, fmt::format("Embree did not start: code {}", rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_, &EmbreeTracer::countMemory, this);
    build();
  }

  ~EmbreeTracer() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    parallelFor(rays.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) blocked[i] = sumAlong(rays[i], threshold_) > threshold_;
    });
  }

  std::uint64_t alphaSum(const Ray& ray) const override { return sumAlong(ray, UINT64_MAX); }
  std::size_t memoryBytes() const override { return bytes_ + particles_.capacity() * sizeof(Particle); }

 private:
  static bool countMemory(void* self, ssize_t bytes, bool) {
    static_cast<EmbreeTracer*>(self)->bytes_ += bytes;
    return true;
  }

  void build() {
    scene_ = rtcNewScene(device_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(particles_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, &EmbreeTracer::bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry, &EmbreeTracer::visit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (const RTCError code = rtcGetDeviceError(device_); code != RTC_ERROR_NONE) {
      throw Error(code == RTC_ERROR_OUT_OF_MEMORY ? Error::Kind::OutOfMemory : Error::Kind::Bug,
                  fmt::format("Embree could not build over {} Gaussians: code {}", particles_.size(),
                              static_cast<int>(code)));
    }
  }

  static void bounds(const RTCBoundsFunctionArguments* a) {
    const Particle& p = static_cast<const EmbreeTracer*>(a->geometryUserPtr)->particles_[a->primID];
    *a->bounds_o = {p.low.x, p.low.y, p.low.z, 0, p.high.x, p.high.y, p.high.z, 0};
  }

  static void visit(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] != -1) return;
    const auto* self = static_cast<const EmbreeTracer*>(a->geometryUserPtr);
    auto* state = static_cast<RayState*>(a->context);
    state->sum += alphaAlong(self->particles_[a->primID], *state->ray, self->desc_.ignore_containing);
    if (state->sum > state->threshold) {
      reinterpret_cast<RTCRay*>(a->ray)->tfar = -INFINITY;  // any-hit stop
    }
  }

  std::uint64_t sumAlong(const Ray& ray, std::uint64_t threshold) const {
    RayState state;
    rtcInitIntersectContext(&state);
    state.ray = &ray;
    state.sum = 0;
    state.threshold = threshold;
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = 0;
    r.tfar = INFINITY;
    r.mask = 0xffffffffu;
    rtcOccluded1(scene_, &state, &r);
    return state.sum;
  }

  TracerDesc desc_;
  std::uint64_t threshold_;
  std::vector<Particle> particles_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::ptrdiff_t> bytes_{0};
};

}  // namespace

std::unique_ptr<Tracer> makeEmbreeTracer(const TracerDesc& desc, const GaussianCloud& cloud) {
  return std::make_unique<EmbreeTracer>(desc, cloud);
}

}  // namespace beam
