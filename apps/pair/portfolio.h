// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/register_pair.h"
#include "grouping/registry.h"

namespace corral {

struct PortfolioOptions {
  double confidence = 0.9;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(OptionField{"confidence", "", "", "probability that the pose is right at which no further grouper is asked",
                      within(0, 1)},
          self.confidence);
  }
};

/// Several groupers as one: GC, 3DHV, TCF, one-point RANSAC, TurboReg and RANSAC in turn, until the best pose so far is probable enough.
///
/// Principle  each grouper's pose is refined over the matches within 5 pr; the pose with the largest table_score so far is the best, and refined over all matches in the end unless it is probable
///            enough; its probability is that of the model of tables (paper/confidence.toml), where a grouper that was not asked
///            counts as one that disagrees.
/// Returns    the rows within 5 pr of the pose, the pose and its probability; nothing if no grouper has a pose. Notes: how many
///            groupers were asked.
/// Cost       that of the groupers asked, two at least, and all six where none is sure.
GroupingResult group_by_portfolio(const CorrespondenceSet& matches, const PortfolioOptions& options = {});

/// "auto" (group_by_portfolio) and "register" (register_pair on the table alone).
std::vector<Grouper> portfolios();

/// The method "register" on a pair with surfaces: as corral register, nothing is refined again. Its time is that of the whole
/// registration.
MethodRecord evaluate_registration(const CorrespondenceSet& matches, const RegisteredSurfaces& surfaces,
                                   const std::optional<PairTruth>& truth);
constexpr char kRegister[] = "register";

/// Gives every refined pose that has no probability that of the model of tables, by the poses of register_pair. Returns the signals
/// of those, one for each record.
std::vector<std::optional<ConfidenceSignals>> rate_poses(std::vector<MethodRecord>& records,
                                                         const CorrespondenceSet& matches,
                                                         const ParallelFor& parallel = one_by_one);

}  // namespace corral
