// SPDX-License-Identifier: MIT
#include "apps/pair/confidence_words.h"

#include <cmath>

#include "apps/runtime/text_table.h"

namespace corral {
namespace {

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

}  // namespace

/// Each is solved for the number that it was made from (confidence_signals()).
std::string signal_words(std::size_t signal, double value) {
  switch (signal) {
    case 0: {
      const auto matches = std::lround(std::exp(value) - 1);
      return matches == 1 ? "1 match agrees with it" : std::to_string(matches) + " matches agree with it";
    }
    case 1:
      return percent(1 / (1 + std::exp(-value))) + " of the matches agree with it";
    case 2:
      return fixed(std::exp(value), 1) + " times as many matches agree with it as with any other pose";
    case 3: {
      const double uncertainty_pr = std::exp(-value) - 0.01;
      return uncertainty_pr > 99 ? "too few matches to determine it"
                                 : "the matches determine it to within " + fixed(uncertainty_pr, 1) + " pr";
    }
    case 4:
      return percent(value) + " of the groupers find it";
    case 5:
      return percent(value) + " of the source lies on the target";
    case 6:
      return "the surfaces are " + fixed(-4 * value, 2) + " pr apart where they overlap";
    case 7:
      return percent(-value) + " of the points are in front of what the other sensor saw";
    default:
      return "the dense refinement moved it by " + fixed(std::exp(-value) - 1, 1) + " pr";
  }
}

std::string confidence_words(const ConfidenceModel& model, const ConfidenceSignals& signals) {
  const auto words = [&](std::size_t signal) { return signal_words(signal, signals[signal]); };
  const double probability = model.probability(signals);
  const std::size_t best = model.strongest(signals), worst = model.weakest(signals), beyond = model.outside(signals);
  std::string text = std::string(verdict(probability)) + ": it is right with a probability of " +
                     fixed(probability, 3) + ", as learned from " + std::to_string(model.pairs) +
                     " pairs with a known pose";
  if (model.term(signals, best) > 0) text += "\n  for it: " + words(best);
  if (model.term(signals, worst) < 0) text += "\n  against it: " + words(worst);
  if (beyond < kSignals) text += "\n  unlike those pairs: " + words(beyond);
  return text;
}

}  // namespace corral
