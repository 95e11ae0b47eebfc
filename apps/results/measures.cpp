// SPDX-License-Identifier: MIT
#include "apps/results/measures.h"

#include <algorithm>
#include <cctype>

#include "apps/pair/confidence.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/pair/truth_fit.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"

namespace corral {
namespace {

using R = StudyRecord;
using Number = std::optional<double>;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr auto Larger = Better::Larger, Smaller = Better::Smaller;
constexpr auto Zero = Absent::Zero, LeftOut = Absent::LeftOut, Infinite = Absent::Infinite;
constexpr auto None = Average::None, Mean = Average::Mean, Median = Average::Median, Pooled = Average::Pooled;
constexpr auto Quantile75 = Average::Quantile75, Quantile95 = Average::Quantile95, Scenes = Average::Scenes;

Stored count(std::optional<int> R::*member) { return {member, nullptr, nullptr, nullptr}; }
Stored number(OptionalNumber R::*member) { return {nullptr, member, nullptr, nullptr}; }

Number inlier_ratio(const R& record) {
  if (!record.matches || !record.true_matches || *record.matches == 0) return std::nullopt;
  return static_cast<double>(*record.true_matches) / *record.matches;
}

/// Whether a pose registers the pair, absent without a pose.
template <PoseScores R::*Pose>
Number success(const R& record) {
  const PoseScores& scores = record.*Pose;
  if (!scores.rotation_error_deg && !scores.mean_error_pr) return std::nullopt;
  return scores.mean_error_pr && *scores.mean_error_pr <= kSuccessPr ? 1 : 0;
}

/// What a probability says of the refined pose: its squared error; whether it is one to trust; whether such a pose is right.
Number brier(const R& record) {
  const Number right = success<&R::refined>(record);
  if (!record.confidence || !right) return std::nullopt;
  return (*record.confidence - *right) * (*record.confidence - *right);
}
Number trusted(const R& record) {
  if (!record.confidence) return std::nullopt;
  return *record.confidence >= kTrusted ? 1 : 0;
}
Number trusted_right(const R& record) {
  return trusted(record).value_or(0) > 0 ? success<&R::refined>(record) : std::nullopt;
}

/// Whether the refinement over all matches gains or loses the pair; absent where it was not asked for.
template <bool IsGain>
Number changed_by_all_rows(const R& record) {
  const Number after = success<&R::all_rows>(record);
  if (!after) return std::nullopt;
  const bool before = success<&R::refined>(record).value_or(0) > 0;
  return (IsGain ? !before && *after > 0 : before && *after == 0) ? 1 : 0;
}

/// A criterion of the field, on the refined pose: largest rotation error (degrees) and translation error (metres).
template <int Rotation, int Centimetres>
Number within(const R& record) {
  const PoseScores& pose = record.refined;
  if (!record.metres_per_pr || !pose.rotation_error_deg || !pose.translation_error_pr) return std::nullopt;
  const double metres = *pose.translation_error_pr * *record.metres_per_pr;
  return *pose.rotation_error_deg <= Rotation && metres <= Centimetres / 100.0 ? 1 : 0;
}

Number rmse_within_20cm(const R& record) {
  if (!record.metres_per_pr || !record.refined.rmse_pr) return std::nullopt;
  return *record.refined.rmse_pr * *record.metres_per_pr <= 0.2 ? 1 : 0;
}

/// Recognised by ADD or ADD-S: below a tenth of the diameter.
template <OptionalNumber PoseScores::*Share>
Number recognised(const R& record) {
  const Number share = record.refined.*Share;
  if (!share) return std::nullopt;
  return *share < kSuccessAddShare ? 1 : 0;
}

template <OptionalNumber PoseScores::*Score>
Number of_refined(const R& record) {
  return record.refined.*Score;
}

Number area(const R& record) {
  const Number error = record.refined.mean_error_pr;
  return error ? Number(success_area({error})) : std::nullopt;
}

// clang-format off
const std::vector<Measure> kOfSelections = {
    {"matches",            "matches",       "", 0, kAny, Larger,  count(&R::matches),      nullptr, LeftOut, None, kOfPair | kOnPage},
    {"true_matches",       "right",         "", 0, kAny, Larger,  count(&R::true_matches), nullptr, LeftOut, None, kOfPair | kOnPage},
    {"selected",           "selected",      "", 0, kAny, Larger,  count(&R::selected),     nullptr, Zero,    None, kOnPage},
    {"correct",            "correct",       "", 0, kAny, Larger,  count(&R::correct),      nullptr, Zero,    None, kOnPage},
    {"precision",          "precision",     "", 3, 1, Larger, number(&R::precision), nullptr, Zero, Mean, kHeadline | kFigure | kOnPage},
    {"recall",             "recall",        "", 3, 1, Larger, number(&R::recall),    nullptr, Zero, Mean, kHeadline | kFigure | kOnPage},
    {"f1",                 "F1",            "", 3, 1, Larger, number(&R::f1),        nullptr, Zero, Mean, kHeadline | kFigure | kOnPage},
    {"success_5pr",        "success",       "", 3, 1, Larger, {}, success<&R::refined>, Zero, Mean,
     kHeadline | kFigure | kWithBounds | kYesOrNo, "aligned within 5 pr"},
    {"pooled_precision",   "pooled precision", "", 3, 1, Larger, {}, nullptr, LeftOut, Pooled, 0, "", {"correct", "selected"}},
    {"pooled_recall",      "pooled recall",    "", 3, 1, Larger, {}, nullptr, LeftOut, Pooled, 0, "", {"correct", "true_matches"}},
    {"precision_nonempty", "precision of non-empty selections", "", 3, 1, Larger, {}, [](const R& r) -> Number { return r.precision; }, LeftOut, Mean},
    {"inlier_ratio",       "inlier ratio",  "", 3, 1, Larger, {}, inlier_ratio, LeftOut, Mean, kOfPair},
    {"frame_share",        "frame share",   "", 3, 1, Larger, number(&R::frame_share), nullptr, LeftOut, Mean, kOfPair},
    {"keypoints_in_overlap", "keypoints in the overlap", "", 0, kAny, Larger, count(&R::keypoints_in_overlap), nullptr, LeftOut, None, kOfPair},
    {"metres_per_pr",      "metres per pr", "m", 4, kAny, Larger, number(&R::metres_per_pr), nullptr, LeftOut, None, kOfPair},
};
const std::vector<Measure> kOfCalls = {
    {"time_ms",             "time",            "ms", 2, kAny, Smaller, number(&R::time_ms), nullptr, LeftOut, None, kOnPage | kEveryPair},
    {"stated_time_ms",      "time, as stated", "ms", 2, kAny, Smaller, number(&R::stated_time_ms), nullptr, LeftOut, Median, kOnPage},
    {"confidence",          "confidence",      "",   3, 1,    Larger,  number(&R::confidence), nullptr, LeftOut, Mean, kOnPage | kIfTried},
    {"brier",               "Brier score",     "",   3, 1,    Smaller, {}, brier,   LeftOut, Mean, kIfTried},
    {"trusted",             "trusted",         "",   3, 1,    Larger,  {}, trusted, LeftOut, Mean, kYesOrNo | kIfTried},
    {"trusted_right",       "right of the trusted", "", 3, 1, Larger,  {}, trusted_right, LeftOut, Mean, kYesOrNo | kIfTried},
    {"success_area",        "success area",    "", 3, 1, Larger, {}, area, Zero, Mean},
    {"initial_success_5pr", "initial success", "", 3, 1, Larger, {}, success<&R::initial>, Zero, Mean,
     kFigure | kWithBounds | kYesOrNo, "aligned within 5 pr, unrefined"},
    {"all_rows_success_5pr", "success over all rows", "", 3, 1, Larger, {}, success<&R::all_rows>, Zero, Mean,
     kFigure | kWithBounds | kYesOrNo | kIfTried, "aligned within 5 pr, refined over all rows"},
    {"all_rows_gained",      "gained over all rows",  "", 3, 1, Larger,  {}, changed_by_all_rows<true>,  Zero, Mean, kYesOrNo | kIfTried},
    {"all_rows_lost",        "lost over all rows",    "", 3, 1, Smaller, {}, changed_by_all_rows<false>, Zero, Mean, kYesOrNo | kIfTried},
    {"dense_success_5pr",   "dense success",   "", 3, 1, Larger, {}, success<&R::dense>, Zero, Mean,
     kFigure | kWithBounds | kYesOrNo | kIfTried, "aligned within 5 pr, dense"},
    {"success_3dmatch",     "3DMatch: 15 deg, 30 cm", "", 3, 1, Larger, {}, within<15, 30>,   Zero, Mean, kYesOrNo | kIfTried},
    {"success_3dmatch_rmse", "3DMatch: RMSE 20 cm",   "", 3, 1, Larger, {}, rmse_within_20cm, Zero, Mean, kYesOrNo | kIfTried},
    {"success_kitti",       "KITTI: 5 deg, 60 cm",    "", 3, 1, Larger, {}, within<5, 60>,    Zero, Mean, kYesOrNo | kIfTried},
    {"success_kitti_2m",    "KITTI: 5 deg, 2 m",      "", 3, 1, Larger, {}, within<5, 200>,   Zero, Mean, kYesOrNo | kIfTried},
    {"success_add",         "ADD below 0.1",          "", 3, 1, Larger, {}, recognised<&PoseScores::add_share>,   Zero, Mean, kYesOrNo | kIfTried},
    {"success_add_s",         "ADD-S below 0.1",        "", 3, 1, Larger, {}, recognised<&PoseScores::add_s_share>, Zero, Mean, kYesOrNo | kIfTried},
    {"success_5pr_scenes",          "success, mean over scenes",                "", 3, 1, Larger, {}, success<&R::refined>, Zero, Scenes, kYesOrNo | kIfTried},
    {"success_3dmatch_scenes",      "3DMatch: 15 deg, 30 cm, mean over scenes", "", 3, 1, Larger, {}, within<15, 30>,       Zero, Scenes, kYesOrNo | kIfTried},
    {"success_3dmatch_rmse_scenes", "3DMatch: RMSE 20 cm, mean over scenes",    "", 3, 1, Larger, {}, rmse_within_20cm,     Zero, Scenes, kYesOrNo | kIfTried},
    {"refined_rotation_error_deg_q75",   "rotation error, 75 %",    "deg", 2, kAny, Smaller, {}, of_refined<&PoseScores::rotation_error_deg>,   Infinite, Quantile75},
    {"refined_rotation_error_deg_q95",   "rotation error, 95 %",    "deg", 2, kAny, Smaller, {}, of_refined<&PoseScores::rotation_error_deg>,   Infinite, Quantile95},
    {"refined_translation_error_pr_q75", "translation error, 75 %", "pr",  2, kAny, Smaller, {}, of_refined<&PoseScores::translation_error_pr>, Infinite, Quantile75},
    {"refined_translation_error_pr_q95", "translation error, 95 %", "pr",  2, kAny, Smaller, {}, of_refined<&PoseScores::translation_error_pr>, Infinite, Quantile95},
    {"refined_mean_error_pr_q75",        "mean error, 75 %",        "pr",  2, kAny, Smaller, {}, of_refined<&PoseScores::mean_error_pr>,        Infinite, Quantile75},
    {"refined_mean_error_pr_q95",        "mean error, 95 %",        "pr",  2, kAny, Smaller, {}, of_refined<&PoseScores::mean_error_pr>,        Infinite, Quantile95},
};

const std::vector<PoseMeasure> kOfPoses = {
    {"rotation_error_deg",   "rotation error",    "deg",       &PoseScores::rotation_error_deg,   true,  false},
    {"translation_error_pr", "translation error", "pr",        &PoseScores::translation_error_pr, true,  false},
    {"mean_error_pr",        "mean error",        "pr",        &PoseScores::mean_error_pr,        true,  true},
    {"rmse_pr",              "RMSE",              "pr",        &PoseScores::rmse_pr,              false, false},
    {"add_share",            "ADD",               "diameters", &PoseScores::add_share,            false, false},
    {"mssd_share",           "MSSD",              "diameters", &PoseScores::mssd_share,           false, false},
    {"add_s_share",          "ADD-S",             "diameters", &PoseScores::add_s_share,          false, false},
};
// clang-format on

/// Errors of a pose that is not there are the worst.
void add_pose(std::vector<Measure>& table, const std::string& stage, PoseScores R::*pose) {
  for (const PoseMeasure& of : kOfPoses) {
    const bool is_summed = of.is_summed && stage == "refined";
    const Stored stored = {nullptr, nullptr, pose, of.score};
    table.push_back({stage + "_" + of.name, std::string(of.title) + ", " + stage, of.unit, 2, kAny, Smaller, stored,
                     nullptr, Infinite, is_summed ? Median : None, is_summed || of.is_on_page ? kOnPage : 0});
  }
}

std::vector<Measure> make_table() {
  std::vector<Measure> table = kOfSelections;
  add_pose(table, "initial", &R::initial);
  add_pose(table, "refined", &R::refined);
  add_pose(table, "all_rows", &R::all_rows);
  add_pose(table, "dense", &R::dense);
  table.insert(table.end(), kOfCalls.begin(), kOfCalls.end());
  return table;
}

}  // namespace

std::optional<double> Measure::of(const StudyRecord& record) const {
  if (derived) return derived(record);
  if (stored.pose) return record.*stored.pose.*stored.score;
  if (stored.number) return record.*stored.number;
  if (stored.count && record.*stored.count) return *(record.*stored.count);
  return std::nullopt;
}

std::string Measure::word() const {
  std::string word = title;
  for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return word;
}

const std::vector<Measure>& measures() {
  static const std::vector<Measure> table = make_table();
  return table;
}

const std::vector<PoseMeasure>& pose_measures() { return kOfPoses; }

std::vector<const Measure*> measures_with(unsigned flag) {
  std::vector<const Measure*> found;
  for (const Measure& measure : measures())
    if (measure.has(flag)) found.push_back(&measure);
  return found;
}

const Measure& measure(const std::string& name) {
  const auto& table = measures();
  const auto found = std::find_if(table.begin(), table.end(), [&](const Measure& entry) { return entry.name == name; });
  if (found == table.end()) throw InvalidInput("measure", "name", name, "one of the table of measures");
  return *found;
}

PairRole role_of(const StudyRecord& record, int least_true_matches) {
  if (!record.matches) return PairRole::Failed;
  if (!record.true_matches) return PairRole::Unjudged;
  if (!record.truth.empty() && !TruthFit::is_belonging(record.truth)) return PairRole::Misfit;
  return *record.true_matches < std::max(1, least_true_matches) ? PairRole::Excluded : PairRole::Judged;
}

double counted_number(const Measure& measure, const StudyRecord& record, PairRole role) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  const bool is_out = role == PairRole::Excluded || role == PairRole::Misfit || role == PairRole::Failed;
  if (is_out && !measure.has(kEveryPair)) return kAbsent;
  if (const auto number = measure.of(record)) return *number;
  if (role != PairRole::Judged || measure.absent == LeftOut) return kAbsent;
  return measure.absent == Zero ? 0 : kAny;
}

}  // namespace corral
