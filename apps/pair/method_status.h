// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "refine/refine_rigid.h"

namespace corral {

/// How a method ended on a pair: as the refinement of its selection (RefineStatus, in its order), or NotConverged (a pose
/// that was still moving), Timed (a call of which only the time was taken), TooLarge (not asked, since it would need more
/// memory than it may), NotApplicable (the table lacks a column that it needs) or Failed (no answer, or the pair could not be
/// matched).
enum class MethodState {
  Refined,
  TooFewRows,
  DegenerateGeometry,
  Diverged,
  NotConverged,
  Timed,
  Unknown,
  TooLarge,
  NotApplicable,
  Failed
};

struct MethodStatus {
  MethodState state = MethodState::Unknown;
  std::string cause = {};  ///< of TooLarge, NotApplicable and Failed
  bool operator==(const MethodStatus& other) const { return state == other.state && cause == other.cause; }
};

/// Of the refinement of a selection.
MethodStatus status_of(const RefinedPose& pose);

/// "refined", "not converged", "too few rows", "degenerate geometry", "diverged", "timed", "too large: CAUSE",
/// "not applicable: CAUSE", "failed: CAUSE"; empty if unknown.
std::string to_text(const MethodStatus& status);
std::optional<MethodStatus> parse_status(const std::string& text);  ///< absent if it is none of these

}  // namespace corral
