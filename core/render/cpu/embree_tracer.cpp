// SPDX-License-Identifier: Apache-2.0
#include "core/render/cpu/embree_tracer.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/cpu/ray_splats.h"
#include "core/render/kernels/response.h"

namespace beam {
namespace {

constexpr std::size_t kRayGrain = 1024;

scalar::RayLine<float> lineOf(const Ray& ray) {
  return {{ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}};
}

scalar::RayTarget<float> targetOf(const RaySplat& s) {
  const float* m = s.canonical;
  return {{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}},
          {s.center.x, s.center.y, s.center.z},
          s.opacity,
          s.cut2};
}

struct Met {
  float units = 0;  // of alpha; 0: it is not met
  float at = 0;     // ray parameter of its maximum
};

Met metBy(const RaySplat& splat, const scalar::RayLine<float>& line, bool ignore_containing) {
  const scalar::RayTarget<float> target = targetOf(splat);
  const scalar::Encounter<float> e = scalar::encounter(target, line);
  if (!scalar::meets(target, e) || !scalar::isAhead(e)) return {};
  if (ignore_containing && scalar::holdsOrigin(target, line)) return {};
  return {scalar::alphaUnits(target, e), scalar::maximumAt(e)};
}

// on_met(index of the splat, Met) returns whether the ray goes on.
using OnMet = std::function<bool(std::uint32_t, const Met&)>;

struct RayState : RTCIntersectContext {
  scalar::RayLine<float> line;
  const OnMet* on_met;
};

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const TracerDesc& desc, const GaussianCloud& cloud)
      : ignore_containing_(desc.ignore_containing),
        free_(freeAlphaUnits(desc)),
        splats_(raySplats(desc, cloud)),
        met_(metSplats(desc, cloud)) {
    // A fixed instruction set: the same tree on every machine.
    device_.reset(rtcNewDevice("isa=avx2"));
    if (!device_)
      throw Error(Error::Kind::Bug,
                  fmt::format("Embree did not start: code {}", static_cast<int>(rtcGetDeviceError(nullptr))));
    rtcSetDeviceMemoryMonitorFunction(device_.get(), &EmbreeTracer::countMemory, this);
    build();
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
    parallelFor(rays.size(), kRayGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) blocked[i] = sumAlong(rays[i], free_) > free_;
    });
  }

  float transmittance(const Ray& ray, const BlendRules& rules) const override {
    std::uint64_t sum = 0;
    along(ray, [&](std::uint32_t splat, const Met& met) {
      if (met.at < rules.reach_m && rules.counts(met_[splat], ray.direction))
        sum += absorbanceUnits(met.units);
      return sum <= kOpaqueUnits;
    });
    return transmittanceOf(sum);
  }

  std::optional<SplatHit> drawn(const Ray& ray, std::uint64_t draw, const BlendRules& rules) const override {
    std::optional<SplatHit> hit;
    along(ray, [&](std::uint32_t splat, const Met& met) {
      if (met.at < (hit ? hit->distance_m : rules.reach_m) && endsIn(met_[splat], met.units, draw) &&
          rules.counts(met_[splat], ray.direction))
        hit = SplatHit{met_[splat], met.at};
      return true;
    });
    return hit;
  }

  std::uint64_t alphaSum(const Ray& ray) const override { return sumAlong(ray, UINT64_MAX); }
  std::size_t memoryBytes() const override {
    return bytes_ + splats_.capacity() * sizeof(RaySplat) + met_.capacity() * sizeof(met_[0]);
  }

 private:
  static bool countMemory(void* self, ssize_t bytes, bool) {
    static_cast<EmbreeTracer*>(self)->bytes_ += bytes;
    return true;
  }

  void build() {
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no box is missed by rounding
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(splats_.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, &EmbreeTracer::bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry, &EmbreeTracer::visit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
    if (const RTCError code = rtcGetDeviceError(device_.get()); code != RTC_ERROR_NONE) {
      throw Error(code == RTC_ERROR_OUT_OF_MEMORY ? Error::Kind::OutOfMemory : Error::Kind::Bug,
                  fmt::format("Embree could not build over {} Gaussians: code {}", splats_.size(),
                              static_cast<int>(code)));
    }
  }

  static void bounds(const RTCBoundsFunctionArguments* a) {
    const RaySplat& p = static_cast<const EmbreeTracer*>(a->geometryUserPtr)->splats_[a->primID];
    *a->bounds_o = {p.low.x, p.low.y, p.low.z, 0, p.high.x, p.high.y, p.high.z, 0};
  }

  static void visit(const RTCOccludedFunctionNArguments* a) {
    if (a->valid[0] != -1) return;
    const auto* self = static_cast<const EmbreeTracer*>(a->geometryUserPtr);
    auto* state = static_cast<RayState*>(a->context);
    const Met met = metBy(self->splats_[a->primID], state->line, self->ignore_containing_);
    if (met.units > 0 && !(*state->on_met)(a->primID, met)) {
      reinterpret_cast<RTCRay*>(a->ray)->tfar = -INFINITY;  // any-hit stop
    }
  }

  std::uint64_t sumAlong(const Ray& ray, std::uint64_t free) const {
    std::uint64_t sum = 0;
    along(ray, [&](std::uint32_t, const Met& met) {
      sum += static_cast<std::uint64_t>(met.units);
      return sum <= free;
    });
    return sum;
  }

  void along(const Ray& ray, const OnMet& on_met) const {
    RayState state;
    rtcInitIntersectContext(&state);
    state.line = lineOf(ray);
    state.on_met = &on_met;
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = 0;
    r.tfar = INFINITY;
    r.mask = 0xffffffffu;
    rtcOccluded1(scene_.get(), &state, &r);
  }

  bool ignore_containing_;
  std::uint64_t free_;
  std::vector<RaySplat> splats_;
  std::vector<std::uint32_t> met_;        // their indices in the cloud
  std::atomic<std::ptrdiff_t> bytes_{0};  // outlives the device, which reports to it
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace

std::unique_ptr<Tracer> makeEmbreeTracer(const TracerDesc& desc, const GaussianCloud& cloud) {
  return std::make_unique<EmbreeTracer>(desc, cloud);
}

}  // namespace beam
