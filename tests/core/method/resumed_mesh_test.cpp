// SPDX-License-Identifier: Apache-2.0
// A mesh that is taken up in the middle is to the bit the one that was made in one go.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "core/base/error.h"
#include "core/method/extract_mesh.h"
#include "tests/support/sphere_capture.h"
#include "tests/support/splat_shapes.h"

namespace beam {
namespace {

using testing::SphereCapture;

const SphereCapture kSphere{.cameras = 16, .size_px = 96};

// Keeps whenever it is asked; stops the work behind the keeping that it is told.
class MemoryCheckpoint final : public Checkpoint {
 public:
  std::vector<std::byte> bytes;
  int keepings = 0, stop_at = 0;
  std::stop_source stop;

  bool due() const override { return true; }
  void keep(const CheckpointWriter& what, const Progress&) override {
    bytes.clear();
    for (const auto& piece : what.pieces()) bytes.insert(bytes.end(), piece.begin(), piece.end());
    if (++keepings == stop_at) stop.request_stop();
  }
  std::unique_ptr<CheckpointReader> kept() const override {
    return bytes.empty() ? nullptr : std::make_unique<Reader>(bytes);
  }

 private:
  class Reader final : public CheckpointReader {
   public:
    explicit Reader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

   protected:
    std::uint64_t left() const override { return bytes_.size() - at_; }
    void read(std::span<std::byte> into) override {
      if (into.size() > left()) throw Error(Error::Kind::Data, "no more");
      std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), into.size(), into.begin());
      at_ += into.size();
    }

   private:
    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
  };
};

ExtractedMesh meshOf(Checkpoint* checkpoint, const MeshScope& scope = {}, std::stop_token stop = {}) {
  GaussianCloud cloud;
  testing::addSphere(cloud, kSphere.center, kSphere.radius_m, 4000);
  std::vector<Camera> cameras;
  for (int i = 0; i < kSphere.cameras; ++i) cameras.push_back(testing::viewOf(kSphere, i).camera);
  const auto device = makeCpuDevice();
  Progress progress(std::move(stop));
  return extractMesh(cloud, cameras, {.voxel_m = 0.0024}, scope, *device, progress, checkpoint);
}

const ExtractedMesh& inOneGo() {
  static const ExtractedMesh mesh = meshOf(nullptr);
  return mesh;
}

void expectEqual(const ExtractedMesh& a, const ExtractedMesh& b) {
  EXPECT_EQ(a.voxel_m, b.voxel_m);
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_TRUE(a.mesh.vertices == b.mesh.vertices);
  EXPECT_TRUE(a.mesh.triangles == b.mesh.triangles);
}

TEST(ResumedMesh, IsToTheBitTheOneMadeInOneGoWhereverItWasCut) {
  MemoryCheckpoint calm;
  expectEqual(meshOf(&calm), inOneGo());
  ASSERT_GE(calm.keepings, 3) << "too few slabs to be cut between";
  for (int cut = 1; cut <= calm.keepings; ++cut) {
    MemoryCheckpoint checkpoint;
    checkpoint.stop_at = cut;
    EXPECT_THROW(meshOf(&checkpoint, {}, checkpoint.stop.get_token()), Cancelled);
    ASSERT_EQ(checkpoint.keepings, cut);
    expectEqual(meshOf(&checkpoint), inOneGo());
    EXPECT_EQ(checkpoint.keepings, calm.keepings) << "slabs that were kept were fused once more";
  }
}

TEST(ResumedMesh, GoesOnWithTheVoxelsThatALimitAskedFor) {
  const MeshScope scope{.most_rows = inOneGo().mesh.triangles.size() / 4};
  const ExtractedMesh whole = meshOf(nullptr, scope);
  ASSERT_EQ(whole.reached, MeshLimit::Rows);
  MemoryCheckpoint calm;
  meshOf(&calm, scope);
  MemoryCheckpoint checkpoint;
  checkpoint.stop_at = calm.keepings;  // in the last try
  EXPECT_THROW(meshOf(&checkpoint, scope, checkpoint.stop.get_token()), Cancelled);
  checkpoint.keepings = 0;
  expectEqual(meshOf(&checkpoint, scope), whole);
  EXPECT_EQ(checkpoint.keepings, 0) << "what passed the limit was tried once more";
}

TEST(ResumedMesh, IsBegunAnewWhereWhatWasKeptIsCutOrOfOtherBlocks) {
  MemoryCheckpoint checkpoint;
  meshOf(&checkpoint);
  const std::vector<std::byte> whole = checkpoint.bytes;
  for (const std::size_t length : {std::size_t{5}, std::size_t{70}, whole.size() / 2, whole.size() - 1}) {
    checkpoint.bytes.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    expectEqual(meshOf(&checkpoint), inOneGo());
  }
  checkpoint.bytes = whole;
  const auto device = makeCpuDevice();
  Progress progress;
  EXPECT_TRUE(
      extractMesh({}, {}, {.voxel_m = 0.0024}, {}, *device, progress, &checkpoint).mesh.vertices.empty());
}

}  // namespace
}  // namespace beam
