// SPDX-License-Identifier: MIT
#include "kernel/local_reference_frame.h"

#include "kernel/rigid_transform.h"

namespace corral {

bool is_valid_frame(const LocalReferenceFrame& frame) { return is_rotation(frame, 1e-4); }

}  // namespace corral
