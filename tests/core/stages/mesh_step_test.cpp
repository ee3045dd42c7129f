// SPDX-License-Identifier: Apache-2.0
// surface.mesh as a step: what it says of a limit, that its file can be read, that it stops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/io/mesh_ply.h"
#include "core/io/splat_ply.h"
#include "core/render/device.h"
#include "core/stages/builtin_stages.h"
#include "core/stages/result_files.h"
#include "core/stages/screening_file.h"
#include "core/stages/step_ids.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A sphere that is seen all around, with the results that the step reads.
class MeshStep : public ::testing::Test {
 protected:
  MeshStep() {
    for (const char* folder : {"screen", "refine", "mesh"}) std::filesystem::create_directory(dir_ / folder);
    for (int i = 0; i < kSphere.cameras; ++i) capture_.views.push_back(viewOf(kSphere, i));
    capture_.frames = {"000"};
    writeScreening(dir_ / "screen", {}, {});
    GaussianCloud cloud;
    addSphere(cloud, kSphere.center, kSphere.radius_m, 4000);
    writeSplatPly(dir_ / "refine" / kCloudFile, cloud, nullptr);
    sink_ = addLogSink([this](const LogRecord& r) {
      if (r.level == LogLevel::Warning) warnings_.push_back(r.text);
    });
  }
  ~MeshStep() override { removeLogSink(sink_); }

  void run(MaskKind masks, std::map<std::string, FieldValue> settings, std::stop_token stop = {},
           Progress::Listener listener = {}) {
    const std::unique_ptr<Stage> stage = makeSurfaceStage();
    for (const auto& [name, value] : settings) {
      FieldSetter setter(name, value);
      stage->parameters(setter);
      ASSERT_TRUE(setter.found) << name;
    }
    capture_.masks = masks;
    const auto device = makeCpuDevice();
    Progress progress(std::move(stop), std::move(listener));
    StepContext context{capture_,
                        {},
                        {},
                        dir_ / "mesh",
                        {{kScreenStep, dir_ / "screen"}, {kRefineStep, dir_ / "refine"}},
                        [](std::string_view) { return FieldValue(1); },
                        *device,
                        progress,
                        {}};
    stage->run("mesh", context);
  }
  Mesh mesh() const { return readMeshPly(dir_ / "mesh" / kMeshFile); }

  const SphereCapture kSphere{.cameras = 16, .size_px = 96};
  TempDir dir_;
  CaptureSet capture_;
  std::vector<std::string> warnings_;
  int sink_ = 0;
};

TEST_F(MeshStep, SaysNothingWhereNoLimitIsReached) {
  run(MaskKind::Files, {{"mesh.voxel_m", 0.02}});
  EXPECT_THAT(warnings_, IsEmpty());
  EXPECT_GT(mesh().triangles.size(), 1000u);
}

TEST_F(MeshStep, NamesTheLimitWhatWasAskedWhatIsUsedAndTheSetting) {
  for (const MaskKind masks : {MaskKind::None, MaskKind::Files}) {
    warnings_.clear();
    run(masks, {{"mesh.voxel_m", 0.0025}, {"mesh.most_voxels", 262144}});
    EXPECT_THAT(warnings_, ElementsAre(AllOf(
                               HasSubstr("voxels of 0.0025 m (surface.mesh.voxel_m)"),
                               HasSubstr(masks == MaskKind::None ? ", in proportion to the scene 0.00" : ""),
                               HasSubstr("limit of 262144 (surface.mesh.most_voxels)"),
                               HasSubstr(" m are used"), HasSubstr("raise the limit"))));
    EXPECT_GT(mesh().triangles.size(), 1000u);
  }
}

TEST_F(MeshStep, StopsInEachOfItsParts) {
  const std::map<std::string, FieldValue> settings = {{"mesh.voxel_m", 0.01}};
  std::vector<std::string> labels;
  run(MaskKind::None, settings, {}, [&](const ProgressReport& r) {
    if (labels.empty() || labels.back() != r.label) labels.push_back(r.label);
  });
  EXPECT_THAT(labels, ::testing::Contains("writing the mesh"));
  for (const std::string& label : labels) {
    std::filesystem::remove(dir_ / "mesh" / kMeshFile);
    std::stop_source stop;
    const auto stopThere = [&](const ProgressReport& r) {
      if (r.label == label) stop.request_stop();
    };
    EXPECT_THROW(run(MaskKind::None, settings, stop.get_token(), stopThere), Cancelled) << label;
    EXPECT_TRUE(std::filesystem::is_empty(dir_ / "mesh")) << label;
  }
}

}  // namespace
}  // namespace beam::testing
