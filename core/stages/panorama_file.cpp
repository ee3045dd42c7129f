// SPDX-License-Identifier: Apache-2.0
#include "core/stages/panorama_file.h"

#include "core/base/log.h"
#include "core/io/image_file.h"
#include "core/render/prepared_light.h"

namespace beam {

std::shared_ptr<const Environment> openPanorama(const std::filesystem::path& file, const Progress& progress) {
  Environment environment = makeEnvironment(readRadiance(file));
  const Image<vec3>& r = environment.radiance;
  if (r.width > kWidestSky) {
    const int width = r.width, height = r.height;
    environment.radiance = reducedPanorama(r, kWidestSky, kWidestSky / 2, progress);
    logWarning("\"{}\" is {}x{}: it is shown from {}x{}, and light falls from {}x{}", file.string(), width,
               height, kWidestSky, kWidestSky / 2, kWidestLight, kWidestLight / 2);
  }
  return std::make_shared<const Environment>(std::move(environment));
}

}  // namespace beam
