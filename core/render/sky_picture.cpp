// SPDX-License-Identifier: Apache-2.0
#include "core/render/sky_picture.h"

#include "core/base/parallel.h"
#include "core/render/pixel_rays.h"

namespace beam {

Image<vec3> skyPicture(const Camera& camera, const EnvironmentLight& light, const Environment& panorama) {
  Image<vec3> sky(camera.width, camera.height, vec3(0), Encoding::Linear);
  const PixelRays rays(camera);
  const dquat panorama_from_world = glm::angleAxis(-glm::radians(light.rotation_deg), dvec3(0, 1, 0));
  parallelFor(static_cast<std::size_t>(camera.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const vec3 direction(panorama_from_world * glm::normalize(rays.worldThrough(x, y)));
        sky(x, y) = static_cast<float>(light.gain) * radianceFrom(panorama, direction);
      }
    }
  });
  return sky;
}

}  // namespace beam
