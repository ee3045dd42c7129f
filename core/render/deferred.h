// SPDX-License-Identifier: Apache-2.0
// Deferred rendering on the CPU: Gaussians to a G-buffer (methods 7.1), G-buffer and light to a picture
// (methods 7.2: SH irradiance, split-sum specular, AO, specular occlusion). Later shaders must match it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/render/device.h"
#include "core/render/prepared_light.h"
#include "core/render/rasterizer_cache.h"
#include "core/render/shaded_lamps.h"
#include "core/scene/gbuffer.h"

namespace beam {

struct ShadeOptions {
  float yaw_rad = 0;               // turns the light about +Y
  float exposure = 1;              // linear factor before encoding
  bool multibounce_ao = true;      // GTAO's coloured fit (methods 5.11)
  bool specular_occlusion = true;  // Lagarde (methods 7.2)
  // By the visibility of a view that has some, in place of occlusion: the panorama casts shadows.
  bool transfer = false;
};

// A view that was rasterised, and what each of its pixels holds. Planes are resized as needed and written
// whole, so that their memory can serve picture after picture. The three of materials and relit() throw
// Error{Bug} unless hasMaterials().
class RasterView {
 public:
  const Camera& camera() const { return camera_; }
  bool hasMaterials() const { return materials_; }
  bool hasVisibility() const { return visibility_ >= 0; }
  void radiance(Planes& out) const;  // sRGB-encoded, composited on black
  void alpha(Planes& out) const;
  void depth(Planes& out) const;   // median z, metres, 0 where alpha < 0.5
  void normal(Planes& out) const;  // unit, world, 0 where alpha < 1/255
  void baseColor(Planes& out) const;
  void occlusion(Planes& out) const;
  void roughness(Planes& out) const;
  // A further attribute, value x alpha as it was blended; Error{Bug} for one that was not drawn.
  void attribute(std::string_view name, Planes& out) const;
  // Linear relit radiance x alpha, premultiplied on black. `lamps`: those that the light was prepared apart
  // from, in the world.
  void relit(const PreparedLight& light, const ShadeOptions& options, const std::vector<ShadedLamp>& lamps,
             Planes& out) const;
  void unlit(Planes& out) const;  // what relit() gives where nothing shines
  // Adds the light of lamps to what relit() gave. Occlusion and visibility are of the panorama alone.
  void addLamps(const std::vector<ShadedLamp>& lamps, Planes& out) const;
  GBuffer gbuffer() const;

 private:
  friend class GBufferRenderer;
  const float* extra(int channel) const { return images_.extra.plane(channel); }
  void share(int channel, int count, Planes& out) const;
  Visibility visibilityAt(std::size_t pixel, float alpha) const;
  // body(pixel, alpha, surface, position) of what is seen; the others as `nothing` does.
  template <class Body, class Nothing>
  void forSurfaces(Body&& body, Nothing&& nothing) const;
  void requireMaterials(const char* what) const;

  Camera camera_;
  bool materials_ = false;
  int visibility_ = -1;  // first of its extra planes; -1: none
  struct Further {
    std::string name;
    int first = 0, channels = 1;  // of the extra planes
  };
  std::vector<Further> further_;
  RasterImages images_;
};

// Draws everything that the scene's attributes can give of a view, materials where every instance has some.
// Keeps its rasterisers between calls of `kept_sizes` sizes, and the last view.
class GBufferRenderer {
 public:
  explicit GBufferRenderer(ComputeDevice& device, std::size_t kept_sizes = 1);
  // Valid until the next call. `further`: names of attributes of the scene that are drawn as well.
  // `visibility`: it is drawn where the scene has some and materials.
  const RasterView& draw(const ResidentScene& scene, const Camera& camera,
                         const std::vector<std::string>& further = {}, bool visibility = false);
  GBuffer render(const ResidentScene& scene, const Camera& camera) { return draw(scene, camera).gbuffer(); }

 private:
  RasterizerCache rasterizers_;
  RasterView view_;
};

// Linear relit radiance x alpha (premultiplied, black background). Throws Error{Bug} without materials.
Image<vec3> shade(const GBuffer& gbuffer, const Camera& camera, const PreparedLight& light,
                  const ShadeOptions& options);

}  // namespace beam
