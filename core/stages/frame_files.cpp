// SPDX-License-Identifier: Apache-2.0
#include "core/stages/frame_files.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/io/visibility_ply.h"
#include "core/stages/result_files.h"
#include "core/stages/step_ids.h"
#include "core/stages/track_files.h"

namespace beam {
namespace {

namespace fs = std::filesystem;

// What `read` makes of the first of `leftovers` that is `wanted`, whole and readable.
template <class Wanted, class Read>
auto firstWhole(const ResultStore& store, const Leftovers& leftovers, Wanted&& wanted, Read&& read)
    -> std::optional<decltype(read(leftovers.front(), fs::path()))> {
  for (const Leftover& leftover : leftovers) {
    if (!wanted(leftover)) continue;
    const std::optional<fs::path> folder = store.verified(leftover.key);
    if (!folder) continue;
    try {
      return read(leftover, *folder);
    } catch (const Error& e) {  // of another version of the program
      logDebug("{} of other settings is passed over: {}", leftover.step.text(), e.what());
    }
  }
  return std::nullopt;
}

// `read` of what readLeftover shows.
template <class Read>
auto newestLeftover(const ResultStore& store, const Leftovers& leftovers, Read&& read)
    -> std::optional<decltype(read(leftovers.front(), fs::path()))> {
  for (const StepId& step : {kMaterialsStep, kRefineStep, kFitStep}) {
    const auto wanted = [&](const Leftover& l) { return l.step == step; };
    if (auto found = firstWhole(store, leftovers, wanted, read)) return found;
  }
  return std::nullopt;
}

GaussianFrame staleFrame(const Leftover& leftover, const fs::path& folder, const char* note) {
  GaussianFrame frame = readFrame(leftover.step, folder);
  frame.stale = true;
  frame.stale_note = note;
  return frame;
}

}  // namespace

GaussianFrame readFrame(const StepId& step, const fs::path& folder) {
  const bool with_materials = step == kMaterialsStep;
  SplatFile file = readSplatPly(folder / (with_materials ? kMaterialsFile : kCloudFile));
  GaussianFrame frame;
  frame.cloud = std::move(file.cloud);
  if (with_materials) frame.materials = std::move(file.materials);
  frame.refined = step != kFitStep;
  return frame;
}

void addVisibility(VisibilityFile file, std::span<const vec3> axes, const fs::path& folder,
                   GaussianFrame& frame) {
  if (file.normal.size() != axes.size()) {
    throw Error(Error::Kind::Data,
                fmt::format("\"{}\": expected {} Gaussians, found {}", (folder / kVisibilityFile).string(),
                            axes.size(), file.normal.size()));
  }
  std::vector<float> sides(axes.size());
  for (std::size_t i = 0; i < sides.size(); ++i)
    sides[i] = glm::dot(file.normal[i], axes[i]) < 0 ? -1.0f : 1.0f;
  frame.attributes.push_back({{.name = kVisibilityName, .channels = 1, .coefficients = kShCount},
                              std::move(file.visibility.coefficients)});
  frame.attributes.push_back({{.name = kNormalSideName}, std::move(sides)});
}

FrameJoints readJoints(const fs::path& folder) {
  return {poseOf(readSplatPly(folder / kJointsFile).cloud), readTrackNote(folder).restarted, false};
}

std::optional<GaussianFrame> readOlderMaterials(const ResultStore& store, const Leftovers& leftovers,
                                                const Digest& surface) {
  return firstWhole(
      store, leftovers, [&](const Leftover& l) { return l.step == kMaterialsStep && l.surface == surface; },
      [](const Leftover& l, const fs::path& folder) {
        return staleFrame(l, folder, "materials made with other settings");
      });
}

std::optional<GaussianFrame> readLeftover(const ResultStore& store, const Leftovers& leftovers) {
  return newestLeftover(store, leftovers, [](const Leftover& l, const fs::path& folder) {
    return staleFrame(l, folder, "made with other settings");
  });
}

std::optional<Mesh> readLeftoverMesh(const ResultStore& store, const Leftovers& leftovers) {
  const auto surface =
      newestLeftover(store, leftovers, [](const Leftover& l, const fs::path&) { return l.surface; });
  if (!surface || *surface == Digest{}) return std::nullopt;
  return firstWhole(
      store, leftovers, [&](const Leftover& l) { return l.step == kMeshStep && l.surface == *surface; },
      [](const Leftover&, const fs::path& folder) { return readMeshPly(folder / kMeshFile); });
}

}  // namespace beam
