// SPDX-License-Identifier: MIT
#include "apps/pair/portfolio.h"

#include <stdexcept>
#include <utility>

#include "apps/pair/confidence_file.h"
#include "apps/runtime/stopwatch.h"
#include "refine/refine_rigid.h"

namespace corral {
namespace {

/// Of proposers(), without their runners-up, by their cost. MAC and SC2-PCR take longer than these together and registered no
/// further pair, nor did runners-up.
const std::vector<std::string> kAsked = {"gc", "hough", "tcf", "frame-ransac", "turboreg", "ransac"};
constexpr int kLeastAsked = 2;  ///< one grouper agrees with itself

Proposer without_runners_up(const std::string& method) {
  for (Proposer proposer : proposers())
    if (proposer.method == method) return proposer.options.erase("keep"), proposer;
  throw std::logic_error(method);
}

class Portfolio {
 public:
  Portfolio(const CorrespondenceSet& matches, const PortfolioOptions& options) : matches_(matches), options_(options) {
    others_.groupers = static_cast<int>(proposers().size());
  }

  GroupingResult run() {
    GroupingResult result;
    int asked = 0;
    for (const std::string& method : kAsked) {
      const auto found = propose(without_runners_up(method), matches_);
      if (!found) continue;  // it does not apply to this table
      ++asked;
      if (found->target_from_source) add_own(*found->target_from_source);
      if (!best_) continue;
      result.confidence = probability();
      if (asked >= kLeastAsked && *result.confidence >= options_.confidence) break;
    }
    result.notes = {{"groupers asked", asked}};
    if (!best_) return result;
    if (*result.confidence < options_.confidence && refine_best()) result.confidence = probability();
    result.target_from_source = best_->target_from_source;
    result.selected = agreeing_rows(matches_, best_->target_from_source);
    return result;
  }

 private:
  /// A grouper's pose, refined over the matches within 5 pr.
  void add_own(const RigidTransform& pose) {
    others_.own.push_back(pose);
    add(refine_rigid(matches_, agreeing_rows(matches_, pose), {}, pose).target_from_source.value_or(pose));
  }

  /// Over all matches, where a weak pose slides to a stronger one. Whether that is better.
  bool refine_best() {
    const auto refined = refine_over_all(matches_, best_->target_from_source).target_from_source;
    return refined && add(*refined);
  }

  /// Whether it is the best so far; equal ones are not.
  bool add(const RigidTransform& pose) {
    others_.all.push_back(pose);
    const double score = table_score(matches_, pose);
    if (best_ && score <= best_->score) return false;
    best_ = ScoredPose{pose, score};
    return true;
  }

  double probability() const {
    return built_in_confidence().table.probability(confidence_signals(matches_, best_->target_from_source, others_));
  }

  const CorrespondenceSet& matches_;
  const PortfolioOptions& options_;
  OtherPoses others_;
  std::optional<ScoredPose> best_;
};

GroupingResult answer_of(const CorrespondenceSet& matches, const Registration& found, const ConfidenceModel& model) {
  GroupingResult result;
  if (found.poses.empty()) return result;
  result.target_from_source = found.poses.front().target_from_source;
  result.selected = agreeing_rows(matches, *result.target_from_source);
  result.confidence = model.probability(*found.signals);
  return result;
}

Grouper portfolio_entry() {
  const auto configure = [](const OptionOverrides& overrides) {
    const auto options = parse_options<PortfolioOptions>(overrides, "auto");
    const auto group = [options](const CorrespondenceSet& matches) { return group_by_portfolio(matches, options); };
    return ConfiguredGrouper{group, describe_options(options), proposers_memory};
  };
  return {"auto",
          "Portfolio (auto)",
          "cheap groupers first, until a pose is probable enough",
          "",
          describe_options(PortfolioOptions{}),
          configure};
}

Grouper registration_entry() {
  const auto configure = [](const OptionOverrides& overrides) {
    if (!overrides.empty()) detail::reject_unknown_option(kRegister, overrides.begin()->first, {});
    const auto group = [](const CorrespondenceSet& matches) {
      return answer_of(matches, register_pair(matches, std::nullopt), built_in_confidence().table);
    };
    return ConfiguredGrouper{group, {}, proposers_memory};
  };
  return {kRegister,
          "Registration (register)",
          "poses of several groupers, chosen on the surfaces where there are any",
          "",
          {},
          configure};
}

}  // namespace

GroupingResult group_by_portfolio(const CorrespondenceSet& matches, const PortfolioOptions& options) {
  return Portfolio(matches, options).run();
}

std::vector<Grouper> portfolios() { return {portfolio_entry(), registration_entry()}; }

MethodRecord evaluate_registration(const CorrespondenceSet& matches, const RegisteredSurfaces& surfaces,
                                   const std::optional<PairTruth>& truth) {
  MethodRecord record;
  record.method = kRegister;
  Stopwatch watch;
  record.found = answer_of(matches, register_pair(matches, surfaces), built_in_confidence().surfaces);
  record.time_ms = watch.lap_ms();
  record.confidence = record.found.confidence;
  if (truth) {
    const auto labels = labels_of(matches, truth->poses(), truth->threshold_pr);
    record.score = score_grouping(labels[best_truth(labels, record.found.selected)], record.found.selected);
  }
  record.pose.initial = record.pose.target_from_source = record.found.target_from_source;
  if (record.pose.target_from_source) record.pose.status = RefineStatus::Refined;
  if (truth) judge_pose(record, *truth, matches.resolution);
  return record;
}

std::vector<std::optional<ConfidenceSignals>> rate_poses(std::vector<MethodRecord>& records,
                                                         const CorrespondenceSet& matches,
                                                         const ParallelFor& parallel) {
  const Registration known = register_pair(matches, std::nullopt, parallel);
  std::vector<std::optional<ConfidenceSignals>> signals(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    MethodRecord& record = records[i];
    if (!record.pose.target_from_source || record.confidence) continue;
    signals[i] = confidence_signals(matches, *record.pose.target_from_source, known.others);
    record.confidence = built_in_confidence().table.probability(*signals[i]);
  }
  return signals;
}

}  // namespace corral
