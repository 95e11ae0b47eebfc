// SPDX-License-Identifier: MIT
#pragma once

#include "kernel/error.h"

namespace corral {

/// A table lacks a column that a grouper needs: it does not apply to that table.
struct MissingColumn : InvalidInput {
  using InvalidInput::InvalidInput;
};

}  // namespace corral
