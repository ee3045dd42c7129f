// SPDX-License-Identifier: Apache-2.0
#include "core/io/visibility_ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/io/file.h"
#include "core/io/ply_file.h"
#include "core/io/splat_ply.h"
#include "tests/support/message_of.h"
#include "tests/support/splat_shapes.h"
#include "tests/support/temp_dir.h"

namespace beam::testing {
namespace {

using ::testing::HasSubstr;

VisibilityFile someFile(std::size_t count) {
  VisibilityFile file{{}, ShBlock(count, 1)};
  const RandomStream r(4);
  for (std::size_t i = 0; i < count; ++i)
    file.normal.push_back(glm::normalize(vec3(r.normal(3 * i), r.normal(3 * i + 1), r.normal(3 * i + 2))));
  fillRandom(file.visibility.coefficients, 5, 0.3f);
  return file;
}

TEST(VisibilityPly, GivesBackWhatWasWritten) {
  const TempDir dir;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{37}}) {
    const VisibilityFile written = someFile(count);
    writeVisibilityPly(dir.path() / "v.ply", written);
    const VisibilityFile read = readVisibilityPly(dir.path() / "v.ply");
    EXPECT_EQ(read.normal, written.normal);
    EXPECT_EQ(read.visibility.coefficients, written.visibility.coefficients);
  }
}

TEST(VisibilityPly, RefusesOtherTablesAndValuesThatAreNone) {
  const TempDir dir;
  const auto file = dir.path() / "v.ply";
  const auto complaint = [&] { return dataErrorOf([&] { readVisibilityPly(file); }); };
  GaussianCloud cloud;
  addSphere(cloud, vec3(0), 1, 5);
  writeSplatPly(file, cloud, nullptr);
  EXPECT_THAT(complaint(), HasSubstr("beam_visibility_dc_0"));
  EXPECT_THAT(complaint(), HasSubstr(file.string()));
  VisibilityFile broken = someFile(3);
  broken.visibility.of(1)[4] = std::numeric_limits<float>::quiet_NaN();
  writeVisibilityPly(file, broken);
  EXPECT_THAT(complaint(), HasSubstr("row 1"));
  writeVisibilityPly(file, someFile(3));
  const std::string whole = readTextFile(file);
  writeFileAtomically(file, whole.substr(0, whole.size() - 4));
  EXPECT_THROW(readVisibilityPly(file), Error);
}

// Of exported splats: by their sides where these are known.
TEST(VisibilityPly, SidesTellTheNormalsOfSplats) {
  const TempDir dir;
  GaussianCloud cloud;
  addSphere(cloud, vec3(0), 1, 40);
  const auto normalsOf = [&](std::span<const float> sides) {
    writeSplatPly(dir.path() / "s.ply", cloud, nullptr, {}, sides);
    const std::vector<PlyElement> elements = readPly(dir.path() / "s.ply");
    std::vector<vec3> normals;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float* row = elements[0].row(i);
      normals.push_back(
          {row[*elements[0].column("nx")], row[*elements[0].column("ny")], row[*elements[0].column("nz")]});
    }
    return normals;
  };
  const std::vector<vec3> outward = normalsOf({});
  const std::vector<float> inward(cloud.size(), -1.0f);  // addSphere's thinnest axes point out of it
  const std::vector<vec3> turned = normalsOf(inward);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_GT(glm::dot(outward[i], cloud.position_m[i]), 0.99f);
    EXPECT_LT(glm::dot(turned[i], cloud.position_m[i]), -0.99f);
  }
}

}  // namespace
}  // namespace beam::testing
