// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/rng.h"
#include "core/scene/capture.h"
#include "core/scene/transform.h"
#include "tests/support/sphere_capture.h"

namespace beam {
namespace {

dmat3 someTurn() { return glm::mat3_cast(glm::normalize(dquat(0.7, 0.3, -0.5, 0.4))); }
Similarity3 someSimilarity() { return {someTurn(), 0.02, dvec3(210, -3, 7)}; }

vec3 randomVec(std::uint64_t i) {
  const RandomStream u(3, i);
  return {u.normal(0), u.normal(1), u.normal(2)};
}

GaussianCloud someCloud() {
  GaussianCloud c;
  c.color = ShBlock(20, 3);
  for (std::uint64_t i = 0; i < 20; ++i) {
    c.position_m.push_back(randomVec(i));
    c.rotation.push_back(glm::normalize(quat(1, randomVec(i + 100))));
    c.scale_m.push_back(glm::abs(randomVec(i + 200)) + 0.01f);
    c.opacity.push_back(0.5f);
  }
  for (std::size_t k = 0; k < c.color.coefficients.size(); ++k)
    c.color.coefficients[k] = static_cast<float>(RandomStream(4, k).normal(0));
  return c;
}

double relativeError(const dvec3& found, const dvec3& expected) {
  return glm::length(found - expected) / (1 + glm::length(expected));
}

TEST(Similarity, ThereAndBackIsWhereItBegan) {
  const Similarity3 s = someSimilarity();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const dvec3 x(randomVec(i));
    EXPECT_LT(relativeError(inverse(s) * (s * x), x), 1e-11);
    EXPECT_LT(relativeError((inverse(s) * s) * x, x), 1e-11);
    const Similarity3 other{glm::transpose(someTurn()), 3, dvec3(1, 2, 3)};
    EXPECT_LT(relativeError((s * other) * x, s * (other * x)), 1e-12);
  }
}

TEST(Similarity, ATurnBetweenAxesRoundsNothingThereOrBack) {
  for (const UpAxis up : {UpAxis::PlusY, UpAxis::PlusZ, UpAxis::MinusY}) {
    const Similarity3 s{worldFromCapture(up)};
    EXPECT_TRUE(isTurn(inverse(s)));
    for (std::uint64_t i = 0; i < 20; ++i) {
      const dvec3 x(randomVec(i));
      EXPECT_EQ(inverse(s) * (s * x), x);
      dvec3 sizes = glm::abs(s * x), expected = glm::abs(x);
      std::sort(&sizes.x, &sizes.x + 3);
      std::sort(&expected.x, &expected.x + 3);
      EXPECT_EQ(sizes, expected) << "only exchanged and negated";
    }
  }
}

TEST(Transformed, TheShapeOfAGaussianFollows) {
  const GaussianCloud before = someCloud(), after = transformed(before, someSimilarity());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT(relativeError(dvec3(after.position_m[i]), someSimilarity() * dvec3(before.position_m[i])),
              1e-6);
    // A point one sigma along each axis of the Gaussian stays one.
    for (int axis = 0; axis < 3; ++axis) {
      vec3 unit(0);
      unit[axis] = 1;
      const dvec3 was = dvec3(before.rotation[i] * (before.scale_m[i] * unit));
      const dvec3 is = dvec3(after.rotation[i] * (after.scale_m[i] * unit));
      EXPECT_LT(glm::length(is - 0.02 * (someTurn() * was)), 1e-6);
    }
  }
  EXPECT_EQ(after.opacity, before.opacity);
}

TEST(Transformed, ColourSeenFromATurnedDirectionStays) {
  const GaussianCloud before = someCloud(), after = transformed(before, someSimilarity());
  for (std::uint64_t i = 0; i < 20; ++i) {
    const vec3 d = glm::normalize(randomVec(i + 300));
    const auto was = shBasis(d), is = shBasis(vec3(someTurn() * dvec3(d)));
    double a = 0, b = 0;
    for (int k = 0; k < kShCount; ++k) {
      a += was[k] * before.color.of(i)[k * 3 + 1];
      b += is[k] * after.color.of(i)[k * 3 + 1];
    }
    EXPECT_NEAR(a, b, 5e-4);
  }
}

TEST(Transformed, APlainAttributeStaysAndOneOfDirectionsTurns) {
  const Attribute plain{{.name = "glow", .channels = 3}, {0.1f, 0.2f, 0.3f}};
  EXPECT_EQ(transformed(plain, someSimilarity()), plain);
  Attribute sh{{.name = "visibility", .coefficients = kShCount}, std::vector<float>(kShCount)};
  sh.values[1] = 1;
  const Attribute turned = transformed(sh, someSimilarity());
  EXPECT_NE(turned, sh);
  double norm = 0;
  for (const float v : turned.values) norm += double(v) * v;
  EXPECT_NEAR(norm, 1, 1e-5) << "a turn keeps the power of a band";
}

CaptureSet someCapture() {
  CaptureSet set;
  for (int i = 0; i < 3; ++i) {
    set.views.push_back({"cam", testing::cameraLookingAt({3.0 * i - 3, 1.5, 2}, {0, 1, 0}, 64, 80)});
    set.seed_points.position_m.push_back(randomVec(static_cast<std::uint64_t>(i)));
  }
  return set;
}

TEST(Transformed, ACameraTakesTheSamePictureOfWhatWentWithItInTheOtherUnit) {
  const Similarity3 s = someSimilarity();
  for (const View& view : someCapture().views) {
    const Camera after = transformed(view.camera, s);
    EXPECT_LT(glm::length(centerOf(after) - s * centerOf(view.camera)), 1e-11);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const dvec3 x(0.3f * randomVec(i));
      const dvec3 was = view.camera.camera_from_world * x, is = after.camera_from_world * (s * x);
      EXPECT_NEAR(is.z, s.scale * was.z, 1e-11);
      EXPECT_LT(glm::length(project(after.intrinsics, is) - project(view.camera.intrinsics, was)), 1e-7);
    }
  }
}

TEST(Transformed, ACaptureGoesThereAndBackOnItsOwnSimilarity) {
  const CaptureSet before = someCapture();
  const CaptureSet world = transformed(before, someSimilarity());
  const CaptureSet back = transformed(world, world.capture_from_world);
  for (std::size_t i = 0; i < before.views.size(); ++i) {
    const Rigid3 &was = before.views[i].camera.camera_from_world,
                 &is = back.views[i].camera.camera_from_world;
    EXPECT_NEAR(std::abs(glm::dot(was.rotation, is.rotation)), 1, 1e-12);
    EXPECT_LT(relativeError(is.translation_m, was.translation_m), 1e-10);
  }
  EXPECT_LT(std::abs(back.capture_from_world.scale - 1), 1e-12);
  EXPECT_LT(glm::length(back.capture_from_world.translation), 1e-10);
}

TEST(Transformed, WhatIsTurnedBackIsThereToTwoUnitsInTheLastPlace) {
  // The last place of a coordinate is that of the longest on its way: an origin far off takes the others'.
  const Similarity3 scaled{worldFromCapture(UpAxis::PlusZ), 0.001, dvec3(0)};
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Mesh world{{randomVec(i)}, {}};
    const Mesh back = transformed(transformed(world, inverse(scaled)), scaled);
    for (int k = 0; k < 3; ++k) {
      const float was = world.vertices[0][k], place = std::abs(std::nextafter(was, 2 * was) - was);
      EXPECT_LE(std::abs(back.vertices[0][k] - was), 2 * place);
    }
  }
}

TEST(Transformed, ATurnedCaptureGoesBackBitForBit) {
  for (const UpAxis up : {UpAxis::PlusY, UpAxis::PlusZ, UpAxis::MinusY}) {
    const CaptureSet before = someCapture(), world = transformed(before, {worldFromCapture(up)});
    EXPECT_EQ(world.capture_from_world, Similarity3{glm::transpose(worldFromCapture(up))});
    for (std::size_t i = 0; i < before.views.size(); ++i) {
      EXPECT_EQ(world.views[i].camera.camera_from_world.translation_m,
                before.views[i].camera.camera_from_world.translation_m)
          << "a camera's own axes do not turn";
    }
    EXPECT_EQ(transformed(world.seed_points, world.capture_from_world).position_m,
              before.seed_points.position_m);
  }
}

TEST(Transformed, NormalsOfAMeshTurnAndStayUnit) {
  Mesh mesh;
  mesh.vertices.emplace_back(1, 2, 3);
  mesh.normals.emplace_back(0, 1, 0);
  mesh.uv.emplace_back(0.25f, 0.75f);
  const Similarity3 a_from_b{worldFromCapture(UpAxis::PlusZ), 1000, dvec3(5, 6, 7)};
  const Mesh turned = transformed(mesh, a_from_b);
  EXPECT_EQ(turned.normals[0], vec3(a_from_b.rotation * dvec3(mesh.normals[0])));
  EXPECT_EQ(turned.vertices[0], vec3(a_from_b * dvec3(mesh.vertices[0])));
  EXPECT_EQ(turned.uv, mesh.uv);
}

TEST(Transformed, RefusesMirrorsAndScalesThatAreNoSizes) {
  EXPECT_THROW(transformed(someCloud(), {dmat3(-1.0)}), Error);
  EXPECT_THROW(transformed(someCloud(), {dmat3(1.0), 0}), Error);
  EXPECT_THROW(transformed(Mesh{}, {dmat3(1.0), -2}), Error);
}

TEST(PointCloud, OfACaptureFarFromItsOriginKeepsItsDetail) {
  std::vector<dvec3> positions;
  for (std::uint64_t i = 0; i < 100; ++i) positions.push_back(dvec3(5e5, 5e6, 100) + dvec3(randomVec(i)));
  const PointCloud capture = pointCloudOf(positions, {});
  const Similarity3 world_from_capture{someTurn(), 1, -(someTurn() * dvec3(5e5, 5e6, 100))};
  const PointCloud world =
      transformed(transformed(capture, {someTurn()}), world_from_capture * inverse(Similarity3{someTurn()}));
  EXPECT_EQ(world.origin, dvec3(0));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    EXPECT_LT(glm::distance(capture.position(i), positions[i]), 1e-6);
    EXPECT_LT(glm::distance(world.position(i), world_from_capture * positions[i]), 1e-6);
  }
}

TEST(PointCloud, OfAnOrdinaryCaptureIsRoundedAsItAlwaysWas) {
  const std::vector<dvec3> positions = {dvec3(210.1, 0.7, -3.3), dvec3(211.3, 2.1, -4.1)};
  const PointCloud points = pointCloudOf(positions, {});
  EXPECT_EQ(points.origin, dvec3(0));
  EXPECT_EQ(points.position_m[0], vec3(positions[0]));
}

TEST(Transformed, SaysWhatSinglePrecisionCostsFarFromTheOrigin) {
  EXPECT_EQ(roundingWarning(Similarity3{}), "");
  EXPECT_EQ(roundingWarning({someTurn(), 1, dvec3(0, -210, 0)}), "");
  EXPECT_EQ(roundingWarning({someTurn(), 1000, dvec3(210000, 0, 0)}), "") << "210 m in millimetres";
  const std::string lost = roundingWarning({someTurn(), 1, dvec3(5e5, -5e6, 100)});
  EXPECT_NE(lost.find("500 mm"), std::string::npos) << lost;
  EXPECT_NE(lost.find("--frame-of world"), std::string::npos) << lost;
}

}  // namespace
}  // namespace beam
