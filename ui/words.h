// SPDX-License-Identifier: Apache-2.0
// Numbers, counts and names of things as the window writes them: one way for all its parts, whatever the
// locale.
#pragma once

#include <QString>

#include <cstdint>
#include <string>
#include <vector>

#include "core/pipeline/stage_registry.h"

namespace beam {

// 1,234,567.
QString numberText(std::int64_t n);
// 20,000; 0.416667; 1.5e-9: at most six digits of what is no whole number.
QString figureText(double value);
// "1 frame", "1,200 frames". `one`: the singular; `many`: where an s at its end will not do.
QString countText(std::int64_t n, const QString& one, const QString& many = {});

// "surface.fit" -> "Surface: fit appearance". An id that no stage has stays as it is.
QString stepTitle(const std::vector<StageInfo>& stages, const StepId& step);
// The ids of steps in a sentence as their titles: what the core and the command line say, as the window does.
QString withStepTitles(const std::vector<StageInfo>& stages, QString text);
// "surface.fit.seconds" -> "Surface, fit appearance: time (s)". A score that is not known here has its unit
// by the end of its name.
QString curveTitle(const std::vector<StageInfo>& stages, const std::string& curve);

}  // namespace beam
