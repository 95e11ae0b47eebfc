// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "apps/study/evaluate_unit.h"

namespace corral {

/// A unit whose selections are only counted (StudyExtent): the groupers run on its table, and nothing else does. Surfaces are read
/// where the store lacks the table, so that a unit takes milliseconds; whether the truth can belong to the pair is judged by
/// the table too. What belongs to poses and surfaces is absent from the result. Throws IoError or InvalidInput.
UnitResult score_unit(const UnitWork& work, std::vector<FileContent>& files);

}  // namespace corral
