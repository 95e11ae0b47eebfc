// SPDX-License-Identifier: MIT
#include "apps/study/score_unit.h"

#include <algorithm>
#include <numeric>

#include "apps/pair/evaluate_pair.h"
#include "apps/pair/read_surface.h"
#include "apps/pair/table_truth_fit.h"
#include "apps/results/study_folder.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"

namespace corral {
namespace {

StoredMatches matches_of(const UnitWork& work) {
  const DatasetPair& pair = work.unit.pair;
  if (!pair.matches.empty()) return {read_matches(pair.matches), 0};
  if (auto found = stored_unit_matches(work)) return std::move(*found);
  return unit_matches(work, read_surface(pair.source), read_surface(pair.target));
}

/// The labels of the matches at one threshold, under each truth.
using Labels = std::vector<std::vector<bool>>;

class TableScores {
 public:
  explicit TableScores(const UnitWork& work) : unit_(work.unit), stored_(matches_of(work)) {
    if (unit_.pair.truth.empty()) return;
    truth_ = table_truth(matches_, read_transform(unit_.pair.truth), unit_.thresholds_pr.front());
    for (const std::string& truth : unit_.pair.equal_truths) truth_->equals.push_back(read_transform(truth));
    for (const double threshold : unit_.thresholds_pr)
      labels_.push_back(labels_of(matches_, truth_->poses(), threshold));
  }

  UnitResult evaluate() {
    UnitResult result;
    result.resolution = matches_.resolution;
    result.source_keypoints = stored_.source_keypoints;
    result.matches = matches_.size();
    result.has_truth = truth_.has_value();
    if (truth_) {
      const TableTruthFit fit = fit_truth(matches_, truth_->target_from_source);
      result.truth = fit.name, result.truth_text = fit.text;
    }
    for (const GroupingTask& task : unit_.tasks) result.tasks.push_back(run(task));
    Indices all(static_cast<std::size_t>(matches_.size()));
    std::iota(all.begin(), all.end(), 0);
    for (const Labels& labels : labels_) {
      const std::vector<bool>& best = labels[best_truth(labels, all)];
      Indices correct;
      for (const int row : all)
        if (best[static_cast<std::size_t>(row)]) correct.push_back(row);
      result.true_matches.push_back(static_cast<int>(correct.size()));
      result.frame_share.push_back(
          frame_repeatability(matches_, truth_->poses()[best_truth(labels, all)], best).share());
      result.oracles.push_back(scored(correct));
    }
    if (truth_) result.baseline = scored(all);
    return result;
  }

  void add_files(std::vector<FileContent>& files) const {
    for (const auto& [file, shown] : unit_.selections) {
      PairSelections selections{matches_.source_keypoints, matches_.target_keypoints, {}, {}, {}};
      selections.matches = static_cast<std::size_t>(matches_.size());
      std::vector<std::string> methods;
      for (const int task : shown) {
        methods.push_back(unit_.tasks[static_cast<std::size_t>(task)].method);
        selections.selected[methods.back()] = selected_[static_cast<std::size_t>(task)];
      }
      files.push_back({file, selections_text(selections, methods)});
    }
  }

 private:
  TaskResult run(const GroupingTask& task) {
    TaskResult result;
    Indices selected;
    try {
      selected = find_grouper(task.method).configure(task.options).group(matches_).selected;
      result = scored(selected);
    } catch (const InvalidInput& error) {
      result.status = {MethodState::Failed, error.what()};
    }
    selected_.push_back(std::move(selected));
    return result;
  }

  TaskResult scored(const Indices& selected) const {
    TaskResult result;
    result.selected = static_cast<int>(selected.size());
    for (const Labels& labels : labels_) {
      const std::vector<bool>& counted = labels[best_truth(labels, selected)];
      result.correct.push_back(score_grouping(counted, selected).correct);
      if (labels.size() > 1)
        result.true_matches.push_back(static_cast<int>(std::count(counted.begin(), counted.end(), true)));
    }
    return result;
  }

  const WorkUnit& unit_;
  const StoredMatches stored_;
  const CorrespondenceSet& matches_ = stored_.matches;
  std::optional<PairTruth> truth_;
  std::vector<Labels> labels_;     ///< at each threshold
  std::vector<Indices> selected_;  ///< of each task
};

}  // namespace

UnitResult score_unit(const UnitWork& work, std::vector<FileContent>& files) {
  TableScores scores(work);
  UnitResult result = scores.evaluate();
  scores.add_files(files);
  return result;
}

}  // namespace corral
