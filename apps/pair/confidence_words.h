// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/pair/confidence.h"

namespace corral {

/// What a signal says of the pose, with its number: "4 matches agree with it".
std::string signal_words(std::size_t signal, double value);

/// The verdict and the probability, then a line each for what weighs most for the pose and against it, if anything does, and for the
/// first signal beyond those of the poses that the model was fitted to.
std::string confidence_words(const ConfidenceModel& model, const ConfidenceSignals& signals);

}  // namespace corral
