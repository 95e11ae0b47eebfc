// SPDX-License-Identifier: MIT
#include "apps/study/evaluate_unit.h"

#include <algorithm>
#include <new>
#include <numeric>

#include "apps/pair/dense_refinement.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/explain.h"
#include "apps/pair/match_pair.h"
#include "apps/pair/methods.h"
#include "apps/pair/normal_sides.h"
#include "apps/pair/portfolio.h"
#include "apps/pair/read_surface.h"
#include "apps/pair/surface_choice.h"
#include "apps/pair/surface_warnings.h"
#include "apps/pair/table_truth_fit.h"
#include "apps/pair/truth_fit.h"
#include "apps/results/study_folder.h"
#include "apps/runtime/build_info.h"
#include "apps/study/score_unit.h"
#include "io/disk/open_file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

/// Part of every key, to be changed with the format of the results; another commit of the program also computes everything
/// again.
constexpr char kFormat[] = "corral study 6";

std::string key_of(const std::vector<std::string>& parts) {
  static const std::string program = "\n" + build_info().version + " " + build_info().commit;
  std::string text = kFormat + program;
  for (const std::string& part : parts) text += "\n" + part;
  return content_hash(text);
}

/// How many there were to describe.
int keypoints_of(const Descriptors& descriptors) {
  return static_cast<int>(descriptors.vertices.size()) + descriptors.dropped_small_support +
         descriptors.dropped_no_frame + descriptors.dropped_no_histogram;
}

/// Keeps the features of a surface that several pairs need in the store.
FeatureCache feature_cache(const UnitWork& work, const std::string& file) {
  return [&work, file](double resolution, const std::function<SurfaceFeatures()>& make) {
    MatchSettings settings = work.unit.matching;
    settings.resolution = to_text(resolution);  // by whatever rule it was computed
    const std::string key = key_of({"features", hash_of(work.inputs, file), matching_text(settings)});
    SurfaceFeatures features;
    if (auto found = work.store.descriptors(key)) {
      features.descriptors = std::move(*found);
      features.keypoints = features.candidates = keypoints_of(features.descriptors);
      return features;
    }
    features = make();
    work.store.put(key, features.descriptors);
    return features;
  };
}

std::string matches_key(const UnitWork& work) {
  const DatasetPair& pair = work.unit.pair;
  return key_of({"matches", hash_of(work.inputs, pair.source), hash_of(work.inputs, pair.target),
                 matching_text(work.unit.matching)});
}

/// Causes are in cells of a table.
std::string one_line(std::string text) {
  for (char& letter : text)
    if (letter == '\n' || letter == '\r') letter = ' ';
  return text;
}

PoseScores pose_scores(const std::optional<PoseErrors>& errors) {
  if (!errors) return {};
  PoseScores scores{errors->rotation_error_deg, errors->translation_error_pr, std::nullopt,       std::nullopt,
                    errors->add_share,          errors->mssd_share,           errors->add_s_share};
  if (errors->points) scores.mean_error_pr = errors->points->mean_pr, scores.rmse_pr = errors->points->rmse_pr;
  return scores;
}

/// The surfaces of a pair.
struct PairSurfaces {
  explicit PairSurfaces(const DatasetPair& pair)
      : source(read_surface(pair.source)),
        target(read_surface(pair.target)),
        source_spacing(point_spacing(source.vertices)),
        target_spacing(point_spacing(target.vertices)) {}

  const Mesh source, target;
  const PointSpacing source_spacing, target_spacing;
};

/// One pair, for all steps after the matching. What needs surfaces is left out where there are none.
class PairStudy {
 public:
  explicit PairStudy(const UnitWork& work) : unit_(work.unit) {
    if (unit_.pair.has_surfaces()) surfaces_.emplace(unit_.pair);
    stored_ = unit_.pair.matches.empty() ? unit_matches(work, surfaces_->source, surfaces_->target)
                                         : StoredMatches{read_matches(unit_.pair.matches), 0};
    std::optional<RigidTransform> target_from_source;
    if (!unit_.pair.truth.empty()) target_from_source = read_transform(unit_.pair.truth);
    if (surfaces_)
      look_at_surfaces(target_from_source);
    else if (target_from_source)
      look_at_table(*target_from_source);
    if (!truth_) return;
    for (const std::string& truth : unit_.pair.equal_truths) truth_->equals.push_back(read_transform(truth));
    for (const double threshold : unit_.thresholds_pr)
      labels_.push_back(labels_of(matches_, truth_->poses(), threshold));
    if (surfaces_ && unit_.pair.matches.empty()) warn_of_sides();
  }

  UnitResult evaluate() {
    for (const GroupingTask& task : unit_.tasks) {
      if (task.answer) {
        records_.push_back(evaluate_answer(task.method, *task.answer, unit_.pair.name, matches_, truth_));
        continue;
      }
      if (task.external) {
        records_.push_back(evaluate_external(*task.external, matches_, truth_, 1));
        continue;
      }
      if (task.method == kRegister && surfaces_) {
        records_.push_back(evaluate_registration(matches_, {surfaces_->source, surfaces_->target, {}, {}}, truth_));
        continue;
      }
      const ConfiguredGrouper grouper = find_method(task.method).configure(task.options);
      records_.push_back(evaluate_method(task.method, grouper, matches_, truth_, 1));
    }
    if (unit_.by_surface && surfaces_)
      choose_by_surfaces(records_, SurfaceChoice(surfaces_->source, surfaces_->target), matches_, truth_);
    if (unit_.confidence) rate_poses(records_, matches_);
    UnitResult result;
    result.resolution = matches_.resolution;
    if (surfaces_) result.source_points = static_cast<int>(surfaces_->source.vertices.rows());
    result.source_keypoints = stored_.source_keypoints;
    result.matches = matches_.size();
    result.has_truth = truth_.has_value();
    if (truth_ && unit_.pair.matches.empty()) result.keypoints_in_overlap = keypoints_in_overlap(matches_, *truth_);
    if (fit_) result.truth = fit_->name(), result.truth_text = fit_->text();
    if (table_fit_) result.truth = table_fit_->name, result.truth_text = table_fit_->text;
    result.warnings = warnings_;
    std::vector<MethodRecord> bounds = evaluate_all_bounds();
    if (unit_.all_rows) {
      refine_all_rows(records_, matches_, truth_);
      refine_all_rows(bounds, matches_, truth_);
    }
    if (unit_.dense && surfaces_) {
      DenseRefinement dense(surfaces_->source, surfaces_->target, matches_.resolution);
      dense.refine(records_, truth_);
      dense.refine(bounds, truth_);
    }
    for (const MethodRecord& record : records_) result.tasks.push_back(result_of(record));
    for (const MethodRecord& bound : bounds) result.oracles.push_back(result_of(bound));
    if (!bounds.empty()) {  // the baseline stands last
      result.baseline = result.oracles.back();
      result.oracles.pop_back();
    }
    for (const auto& labels : labels_) {
      const std::size_t best = best_truth(labels, all_rows());
      result.true_matches.push_back(count_of(labels[best]));
      result.frame_share.push_back(frame_repeatability(matches_, truth_->poses()[best], labels[best]).share());
    }
    return result;
  }

  void add_files(std::vector<FileContent>& files) const {
    for (const auto& [file, shown] : unit_.selections) {
      PairSelections selections{matches_.source_keypoints, matches_.target_keypoints, residuals(), {}, {}};
      selections.matches = static_cast<std::size_t>(matches_.size());
      std::vector<std::string> methods;
      std::vector<StudyPose> poses;
      for (const int task : shown) {
        const MethodRecord& record = records_[static_cast<std::size_t>(task)];
        methods.push_back(record.method);
        selections.selected[record.method] = record.found.selected;
        const auto add = [&](const char* stage, const std::optional<RigidTransform>& pose) {
          if (pose) poses.push_back({record.method, stage, *pose});
        };
        add("initial", record.pose.initial);
        add("refined", record.pose.target_from_source);
        if (record.all_rows) add("all rows", record.all_rows->target_from_source);
        if (record.dense) add("dense", record.dense->target_from_source);
      }
      files.push_back({file, selections_text(selections, methods)});
      files.push_back({file.substr(0, file.size() - 4) + ".poses.csv", poses_text(poses)});
    }
  }

 private:
  /// Judges the truth by them, and warns of what makes results wrong.
  void look_at_surfaces(const std::optional<RigidTransform>& target_from_source) {
    const auto& [source, target, source_spacing, target_spacing] = *surfaces_;
    for (const std::string& warning : surface_warnings(source, source_spacing))
      warnings_.push_back("source: " + warning);
    for (const std::string& warning : surface_warnings(target, target_spacing))
      warnings_.push_back("target: " + warning);
    const std::string units = unit_warning(size_of(source.vertices, source_spacing.resolution),
                                           size_of(target.vertices, target_spacing.resolution));
    if (target_from_source) {
      truth_ = pair_truth(source, target, *target_from_source, matches_.resolution, unit_.thresholds_pr.front());
      fit_ = fit_truth(source, target, *target_from_source, source_spacing, target_spacing);
    }
    if (!units.empty() && !(fit_ && fit_->belongs())) warnings_.push_back(units);
  }

  void look_at_table(const RigidTransform& target_from_source) {
    truth_ = table_truth(matches_, target_from_source, unit_.thresholds_pr.front());
    table_fit_ = fit_truth(matches_, target_from_source);
  }

  /// Where hardly any match is correct, opposed normals are a likely cause, and worth their time.
  void warn_of_sides() {
    const auto most = std::max_element(unit_.thresholds_pr.begin(), unit_.thresholds_pr.end());
    const std::vector<bool> labels = label_correct(matches_, truth_->target_from_source, *most);
    constexpr int kHardlyAny = 3;
    if (!fit_->belongs() || std::count(labels.begin(), labels.end(), true) >= kHardlyAny) return;
    const auto opposed = opposed_normals(surfaces_->source, surfaces_->target, truth_->target_from_source,
                                         matches_.resolution, unit_.matching);
    if (is_opposed(opposed)) warnings_.push_back(opposed_warning(*opposed));
  }

  /// The oracle of every threshold, then the baseline.
  std::vector<MethodRecord> evaluate_all_bounds() const {
    std::vector<MethodRecord> bounds, last;
    if (!truth_) return bounds;
    PairTruth truth = *truth_;
    for (const double threshold : unit_.thresholds_pr) {
      truth.threshold_pr = threshold;
      last = evaluate_bounds(matches_, truth);
      bounds.push_back(std::move(last.front()));
    }
    bounds.push_back(std::move(last.back()));
    return bounds;
  }

  TaskResult result_of(const MethodRecord& record) const {
    TaskResult result;
    result.status = record.status();
    result.status.cause = one_line(result.status.cause);
    result.time_ms = record.time_ms;
    result.stated_time_ms = record.stated_time_ms;
    result.confidence = record.confidence;
    if (!record.failure.empty()) return result;
    result.selected = static_cast<int>(record.found.selected.size());
    for (const auto& labels : labels_) {
      const std::vector<bool>& counted = labels[best_truth(labels, record.found.selected)];
      result.correct.push_back(score_grouping(counted, record.found.selected).correct);
      if (labels.size() > 1) result.true_matches.push_back(count_of(counted));
    }
    result.initial = pose_scores(record.initial_errors);
    result.refined = pose_scores(record.errors);
    result.all_rows = pose_scores(record.all_rows_errors);
    result.dense = pose_scores(record.dense_errors);
    return result;
  }

  static int count_of(const std::vector<bool>& labels) {
    return static_cast<int>(std::count(labels.begin(), labels.end(), true));
  }

  Indices all_rows() const {
    Indices rows(static_cast<std::size_t>(matches_.size()));
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
  }

  std::vector<double> residuals() const {
    std::vector<double> residuals;
    if (!truth_) return residuals;
    const Points images = truth_->target_from_source.apply(matches_.source_points);
    for (int row = 0; row < matches_.size(); ++row)
      residuals.push_back((images.row(row) - matches_.target_points.row(row)).norm() / matches_.resolution);
    return residuals;
  }

  const WorkUnit& unit_;
  std::optional<PairSurfaces> surfaces_;
  StoredMatches stored_;
  const CorrespondenceSet& matches_ = stored_.matches;
  std::optional<PairTruth> truth_;
  std::optional<TruthFit> fit_;             ///< of the surfaces
  std::optional<TableTruthFit> table_fit_;  ///< where there are none
  std::vector<std::string> warnings_;
  std::vector<std::vector<std::vector<bool>>> labels_;  ///< at each threshold, under each truth
  std::vector<MethodRecord> records_;                   ///< one for each task
};

}  // namespace

std::string hash_of(const InputHashes& inputs, const std::string& path) {
  const auto found = inputs.find(path);
  return found == inputs.end() ? std::string() : found->second;
}

std::string unit_key(const WorkUnit& unit) { return key_of({"unit", unit_text(unit)}); }

std::optional<StoredMatches> stored_unit_matches(const UnitWork& work) { return work.store.matches(matches_key(work)); }

StoredMatches unit_matches(const UnitWork& work, const Mesh& source, const Mesh& target) {
  const WorkUnit& unit = work.unit;
  if (auto found = stored_unit_matches(work)) return std::move(*found);
  MatchHooks hooks;
  if (unit.shares_source) hooks.source = feature_cache(work, unit.pair.source);
  if (unit.shares_target) hooks.target = feature_cache(work, unit.pair.target);
  MatchedPair pair = match_pair(source, target, unit.matching, hooks);
  const StoredMatches made{std::move(pair.matches), pair.report.source.keypoints};
  work.store.put(matches_key(work), made);
  return made;
}

UnitResult evaluate_unit(const UnitWork& work, std::vector<FileContent>& files) {
  try {
    if (work.unit.extent != StudyExtent::Poses) return score_unit(work, files);
    PairStudy study(work);
    UnitResult result = study.evaluate();
    study.add_files(files);
    return result;
  } catch (const std::bad_alloc&) {
    throw;  // not a failure of the pair
  } catch (const std::exception& error) {
    UnitResult failed;
    failed.is_unreadable = dynamic_cast<const SystemError*>(&error) != nullptr;
    failed.failure = *error.what() ? one_line(error.what()) : "no reason given";
    return failed;
  }
}

}  // namespace corral
