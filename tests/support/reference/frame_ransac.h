// SPDX-License-Identifier: MIT
#pragma once

#include "grouping/frame_ransac.h"
#include "tests/support/reference/groupers.h"

namespace corral::reference {

/// All poses are judged and sorted.
Selection frame_ransac(const CorrespondenceSet& matches, const FrameRansacOptions& options);

}  // namespace corral::reference
