// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_result.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

FrameResult readStep(std::string_view step, const fs::path& folder) {
  if (step == kMaterialsStep) {
    SplatFile file = readSplatPly(folder / kMaterialsFile);
    return {.cloud = std::move(file.cloud), .materials = std::move(file.materials), .refined = true};
  }
  return {.cloud = readSplatPly(folder / kCloudFile).cloud,
          .materials = std::nullopt,
          .refined = step == kRefineStep};
}

// What `read` makes of the first of `leftovers` that is `wanted`, whole and readable.
template <class Wanted, class Read>
auto firstWhole(const Project& project, const Leftovers& leftovers, Wanted&& wanted, Read&& read)
    -> std::optional<decltype(read(leftovers.front(), fs::path()))> {
  for (const Leftover& leftover : leftovers) {
    if (!wanted(leftover)) continue;
    const std::optional<fs::path> folder = project.store().verified(leftover.key);
    if (!folder) continue;
    try {
      return read(leftover, *folder);
    } catch (const Error& e) {  // of another version of the program
      logDebug("{} of other settings is passed over: {}", leftover.step, e.what());
    }
  }
  return std::nullopt;
}

// `read` of what loadLeftover shows.
template <class Read>
auto newestLeftover(const Project& project, const Leftovers& leftovers, Read&& read)
    -> std::optional<decltype(read(leftovers.front(), fs::path()))> {
  for (const char* step : {kMaterialsStep, kRefineStep, kFitStep}) {
    const auto wanted = [&](const Leftover& l) { return l.step == step; };
    if (auto found = firstWhole(project, leftovers, wanted, read)) return found;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FrameResult> loadFrameResult(const Project& project, FrameIndex frame) {
  for (const char* step : {kMaterialsStep, kRefineStep, kFitStep}) {
    if (const auto folder = project.result(step, frame)) return readStep(step, *folder);
  }
  return std::nullopt;
}

std::optional<Mesh> loadFrameMesh(const Project& project, FrameIndex frame) {
  const auto folder = project.result(kMeshStep, frame);
  if (!folder) return std::nullopt;
  return readMeshPly(*folder / kMeshFile);
}

std::optional<FrameResult> loadOlderMaterials(const Project& project, FrameIndex frame,
                                              const Leftovers& leftovers) {
  const auto isMaterials = [](const Leftover& l) { return l.step == kMaterialsStep; };
  if (std::none_of(leftovers.begin(), leftovers.end(), isMaterials)) return std::nullopt;
  const Digest surface = project.key(kRefineStep, frame);
  return firstWhole(
      project, leftovers, [&](const Leftover& l) { return isMaterials(l) && l.surface == surface; },
      [](const Leftover& l, const fs::path& folder) {
        FrameResult result = readStep(l.step, folder);
        result.stale = true;
        result.stale_note = "materials made with other settings";
        return result;
      });
}

std::optional<FrameResult> loadLeftover(const Project& project, const Leftovers& leftovers) {
  return newestLeftover(project, leftovers, [](const Leftover& l, const fs::path& folder) {
    FrameResult result = readStep(l.step, folder);
    result.stale = true;
    result.stale_note = "made with other settings";
    return result;
  });
}

std::optional<Mesh> loadLeftoverMesh(const Project& project, const Leftovers& leftovers) {
  const auto surface =
      newestLeftover(project, leftovers, [](const Leftover& l, const fs::path&) { return l.surface; });
  if (!surface || *surface == Digest{}) return std::nullopt;
  return firstWhole(
      project, leftovers, [&](const Leftover& l) { return l.step == kMeshStep && l.surface == *surface; },
      [](const Leftover&, const fs::path& folder) { return readMeshPly(folder / kMeshFile); });
}

}  // namespace beam
