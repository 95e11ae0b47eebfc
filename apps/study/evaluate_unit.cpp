// SPDX-License-Identifier: MIT
#include "apps/study/evaluate_unit.h"

#include <algorithm>
#include <new>

#include "apps/pair/dense_refinement.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/read_surface.h"
#include "apps/results/run_folder.h"
#include "apps/runtime/build_info.h"
#include "apps/runtime/workers.h"
#include "io/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

/// Part of every key, to be changed with whatever makes something else of the same input; another commit of the program makes
/// everything anew too.
constexpr char kFormat[] = "corral study 2";

std::string key_of(const std::vector<std::string>& parts) {
  static const std::string program = "\n" + build_info().version + " " + build_info().commit;
  std::string text = kFormat + program;
  for (const std::string& part : parts) text += "\n" + part;
  return content_hash(text);
}

Descriptors describe(const Mesh& mesh, double resolution, const MatchSettings& settings) {
  const Points normals = estimate_normals(mesh, normal_options(settings), workers(settings.threads));
  return describe_surface(mesh, normals, resolution, settings).descriptors;
}

/// Features that several pairs need, from the store or stored.
Descriptors shared_descriptors(const Mesh& mesh, const std::string& hash, const MatchSettings& settings,
                               const ContentStore& store) {
  const double resolution = parse_double(settings.resolution).value();
  const std::string key = key_of({"features", hash, matching_text(settings)});
  if (auto found = store.descriptors(key)) return std::move(*found);
  Descriptors descriptors = describe(mesh, resolution, settings);
  store.put(key, descriptors);
  return descriptors;
}

/// How many there were to describe.
int keypoints_of(const Descriptors& descriptors) {
  return static_cast<int>(descriptors.vertices.size()) + descriptors.dropped_small_support +
         descriptors.dropped_no_frame + descriptors.dropped_no_histogram;
}

/// Causes are in cells of a table.
std::string one_line(std::string text) {
  for (char& letter : text)
    if (letter == '\n' || letter == '\r') letter = ' ';
  return text;
}

PoseScores pose_scores(const std::optional<PoseErrors>& errors) {
  if (!errors) return {};
  PoseScores scores{errors->rotation_error_deg, errors->translation_error_pr, std::nullopt, std::nullopt,
                    errors->add_share};
  if (errors->points) scores.mean_error_pr = errors->points->mean_pr, scores.rmse_pr = errors->points->rmse_pr;
  return scores;
}

/// One pair with its meshes: what all steps after the matching share.
class PairStudy {
 public:
  explicit PairStudy(const UnitWork& work)
      : unit_(work.unit),
        source_(read_surface(unit_.pair.source)),
        target_(read_surface(unit_.pair.target)),
        stored_(unit_matches(work, source_, target_)),
        matches_(stored_.matches) {
    if (unit_.pair.truth.empty()) return;
    truth_ = pair_truth(source_, target_, read_transform(unit_.pair.truth), matches_.resolution,
                        unit_.thresholds_pr.front());
    for (const double threshold : unit_.thresholds_pr)
      labels_.push_back(label_inliers(matches_, truth_->target_from_source, threshold));
  }

  UnitResult evaluate() {
    for (const GroupingTask& task : unit_.tasks) {
      const ConfiguredGrouper grouper = find_grouper(task.method).configure(task.options);
      records_.push_back(evaluate_method(task.method, grouper, matches_, truth_, 1));
    }
    UnitResult result;
    result.resolution = matches_.resolution;
    result.source_points = static_cast<int>(source_.vertices.rows());
    result.source_keypoints = stored_.source_keypoints;
    result.matches = matches_.size();
    result.has_truth = truth_.has_value();
    std::vector<MethodRecord> bounds = evaluate_all_bounds();
    if (unit_.dense) {
      DenseRefinement dense(source_, target_, matches_.resolution);
      dense.refine(records_, truth_);
      dense.refine(bounds, truth_);
    }
    for (const MethodRecord& record : records_) result.tasks.push_back(result_of(record));
    for (const MethodRecord& bound : bounds) result.oracles.push_back(result_of(bound));
    if (!bounds.empty()) {  // the floor stands last
      result.floor = result.oracles.back();
      result.oracles.pop_back();
    }
    for (const std::vector<bool>& labels : labels_) {
      result.true_matches.push_back(static_cast<int>(std::count(labels.begin(), labels.end(), true)));
      result.frame_share.push_back(frame_repeatability(matches_, truth_->target_from_source, labels).share());
    }
    return result;
  }

  void add_files(std::vector<FileContent>& files) const {
    for (const auto& [file, shown] : unit_.selections) {
      PairSelections selections{matches_.source_keypoints, matches_.target_keypoints, residuals(), {}};
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
        if (record.dense) add("dense", record.dense->target_from_source);
      }
      files.push_back({file, selections_text(selections, methods)});
      files.push_back({file.substr(0, file.size() - 4) + ".poses.csv", poses_text(poses)});
    }
  }

 private:
  /// The oracle of every threshold, then the floor.
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
    if (!record.failure.empty()) return result;
    result.selected = static_cast<int>(record.found.selected.size());
    for (const std::vector<bool>& labels : labels_)
      result.correct.push_back(score_grouping(labels, record.found.selected).correct);
    result.initial = pose_scores(record.initial_errors);
    result.refined = pose_scores(record.errors);
    result.dense = pose_scores(record.dense_errors);
    return result;
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
  const Mesh source_, target_;
  const StoredMatches stored_;
  const CorrespondenceSet& matches_;
  std::optional<PairTruth> truth_;
  std::vector<std::vector<bool>> labels_;  ///< at each threshold
  std::vector<MethodRecord> records_;      ///< one for each task
};

}  // namespace

std::string hash_of(const InputHashes& inputs, const std::string& path) {
  const auto found = inputs.find(path);
  return found == inputs.end() ? std::string() : found->second;
}

std::string unit_key(const WorkUnit& unit, const InputHashes& inputs) {
  return key_of({"unit", hash_of(inputs, unit.pair.source), hash_of(inputs, unit.pair.target),
                 hash_of(inputs, unit.pair.truth), unit_text(unit)});
}

StoredMatches unit_matches(const UnitWork& work, const Mesh& source, const Mesh& target) {
  const WorkUnit& unit = work.unit;
  const std::string source_hash = hash_of(work.inputs, unit.pair.source),
                    target_hash = hash_of(work.inputs, unit.pair.target);
  const std::string key = key_of({"matches", source_hash, target_hash, matching_text(unit.matching)});
  if (auto found = work.store.matches(key)) return std::move(*found);
  source.validate("source");
  target.validate("target");
  const double resolution =
      pair_resolution(unit.matching.resolution, point_resolution(source.vertices), point_resolution(target.vertices));
  MatchSettings settings = unit.matching;
  settings.resolution = to_text(resolution);  // whatever rule it came from
  const auto described = [&](const Mesh& mesh, const std::string& hash, bool is_shared) {
    return is_shared ? shared_descriptors(mesh, hash, settings, work.store) : describe(mesh, resolution, unit.matching);
  };
  const Descriptors on_source = described(source, source_hash, unit.shares_source);
  const Descriptors on_target = described(target, target_hash, unit.shares_target);
  const StoredMatches made{match_surfaces({source, on_source}, {target, on_target}, resolution, unit.matching),
                           keypoints_of(on_source)};
  work.store.put(key, made);
  return made;
}

UnitResult evaluate_unit(const UnitWork& work, std::vector<FileContent>& files) {
  try {
    PairStudy study(work);
    UnitResult result = study.evaluate();
    study.add_files(files);
    return result;
  } catch (const std::bad_alloc&) {
    throw;  // says nothing about the pair
  } catch (const std::exception& error) {
    UnitResult failed;
    failed.failure = *error.what() ? one_line(error.what()) : "no reason given";
    return failed;
  }
}

}  // namespace corral
