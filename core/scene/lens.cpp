// SPDX-License-Identifier: Apache-2.0
#include "core/scene/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/scene/camera.h"

namespace beam {
namespace {

// All that there is to a model; everything else of this file holds for each.
struct LensModel {
  std::string_view name;
  std::size_t parameters;
  LensPoint (*distort)(const LensParameters&, const dvec2&);
  std::optional<dvec2> (*undistort)(const LensParameters&, const dvec2&);
  double (*radius)(const LensParameters&);  // of the undistorted points of which distort is one to one
};

constexpr LensModel kModels[] = {
    {"pinhole", 0,
     [](const LensParameters&, const dvec2& point) {
       return LensPoint{point, dmat2(1), {}};
     },
     [](const LensParameters&, const dvec2& point) -> std::optional<dvec2> { return point; },
     [](const LensParameters&) { return std::numeric_limits<double>::infinity(); }},
};

const LensModel* findModel(std::string_view name) {
  const auto* model = std::ranges::find(kModels, name, &LensModel::name);
  return model == std::end(kModels) ? nullptr : model;
}

const LensModel& modelOf(const Lens& lens) {
  if (const LensModel* model = findModel(lens.model)) return *model;
  throw Error(Error::Kind::Bug, fmt::format("expected a known lens, found \"{}\"", lens.model));
}

}  // namespace

const std::vector<std::string>& lensModels() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const LensModel& model : kModels) all.emplace_back(model.name);
    return all;
  }();
  return names;
}

std::size_t parameterCount(const Lens& lens) { return modelOf(lens).parameters; }

void validate(const Lens& lens, std::string_view name) {
  const LensModel* model = findModel(lens.model);
  if (!model) {
    throw Error(Error::Kind::Data,
                fmt::format("camera \"{}\": expected a lens that is one of {}, found \"{}\"", name,
                            fmt::join(lensModels(), ", "), lens.model));
  }
  for (std::size_t i = 0; i < lens.parameters.size(); ++i) {
    const double value = lens.parameters[i];
    if (i < model->parameters ? std::isfinite(value) : value == 0) continue;
    throw Error(Error::Kind::Data,
                fmt::format("camera \"{}\": expected {} as parameter {} of a {} lens, found {}", name,
                            i < model->parameters ? "a finite number" : "0", i + 1, lens.model, value));
  }
}

LensPoint distort(const Lens& lens, const dvec2& undistorted) {
  return modelOf(lens).distort(lens.parameters, undistorted);
}

std::optional<LensPoint> undistort(const Lens& lens, const dvec2& distorted) {
  const LensModel& model = modelOf(lens);
  const std::optional<dvec2> found = model.undistort(lens.parameters, distorted);
  if (!found) return std::nullopt;
  // Of the inverse function: with d = distort(u, p) held, du = J^-1 (dd - P dp).
  const LensPoint there = model.distort(lens.parameters, *found);
  LensPoint back{*found, glm::inverse(there.by_point), {}};
  for (std::size_t i = 0; i < model.parameters; ++i)
    back.by_parameter[i] = -(back.by_point * there.by_parameter[i]);
  return back;
}

LensRegion validRegion(const Camera& camera) {
  const auto corner = [&](double x, double y) { return dvec2(rayOf(camera.intrinsics, {x, y})); };
  return {modelOf(camera.lens).radius(camera.lens.parameters), corner(0, 0),
          corner(camera.width, camera.height)};
}

void requirePinhole(const Camera& camera, std::string_view who) {
  if (isPinhole(camera.lens)) return;
  throw Error(Error::Kind::Bug,
              fmt::format("{}: expected the camera of an undistorted picture, found a \"{}\" lens", who,
                          camera.lens.model));
}

}  // namespace beam
