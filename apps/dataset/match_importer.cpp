// SPDX-License-Identifier: MIT
#include "apps/dataset/match_importer.h"

#include <algorithm>

#include "apps/pair/match_features.h"
#include "apps/pair/match_settings.h"
#include "apps/pair/read_surface.h"
#include "apps/runtime/text_table.h"
#include "io/matches/foreign_matches.h"
#include "io/matches/label_file.h"
#include "io/matches/matches_file.h"
#include "io/matches/named_arrays.h"
#include "io/pose/pose_entry.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/evaluation.h"
#include "kernel/number_text.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

constexpr double kCorrectPr = 4;

/// A table of this program begins with its name.
bool is_own_table(const std::string& path) {
  static const std::string kEnding = ".matches.csv";
  return path.size() > kEnding.size() && path.compare(path.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
}

void append(std::vector<std::string>& notes, const std::string& path, const std::vector<std::string>& more) {
  for (const std::string& note : more) notes.push_back(path + ": " + note);
}

/// A rotation and a translation in two files.
RigidTransform read_two(const std::string& rotation, const std::string& translation) {
  const NumberTable turn = read_number_table(rotation), shift = read_number_table(translation);
  if (turn.size() != 3 || turn.width() != 3)
    throw IoError(rotation, "", "expected a rotation, three rows of three numbers");
  if (shift.rows.size() != 3) throw IoError(translation, "", "expected a translation, three numbers");
  PoseEntry entry;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      entry.numbers.push_back(column < 3 ? turn.rows(column, row) : shift.rows.data()[row]);
  return rigid_pose(rotation, entry);
}

/// One cloud of indices: no point may have been left out, or all that follow would be others.
Points indexed_points(const std::string& path) {
  if (path.empty()) return {};
  const StoredMesh mesh = read_surface(path);
  for (const std::string& note : mesh.notes)
    if (note.find("left out") != std::string::npos)
      throw IoError(path, "",
                    note + ", so that the indices of the matches count other points; expected a cloud without them");
  return mesh.vertices;
}

/// Matches, pose and labels of one pair before the resolution is known.
struct RawPair {
  std::optional<ForeignMatches> found;
  bool has_resolution = false;
};

ForeignMatches matched(const FeaturePoints& source, const FeaturePoints& target, const MatchImportOptions& options) {
  ForeignMatches found;
  found.matches = match_feature_points(source, target, options.matching, options.parallel);
  found.rows = found.matches.size();
  for (int row = 0; row < found.rows; ++row) found.kept.push_back(row);
  return found;
}

/// A .npz that has features of both sides, and no matches.
std::optional<ForeignMatches> match_archive(const std::string& path, const MatchImportOptions& options) {
  if (!is_archive(path)) return std::nullopt;
  NamedArrays arrays(path);
  const NamedArrays::Pair points = arrays.points(), features = arrays.features();
  if (!arrays.matches().empty() || points.source.empty() || features.source.empty()) return std::nullopt;
  ForeignMatches found = matched(features_of(arrays.read(points.source), arrays.read(features.source)),
                                 features_of(arrays.read(points.target), arrays.read(features.target)), options);
  found.target_from_source = arrays.pose();
  found.notes.push_back("the features of " + features.source + " and " + features.target +
                        " are matched as they are, by their distance");
  return found;
}

RawPair read_raw(const PairFiles& files, const MatchImportOptions& options) {
  RawPair raw;
  if (files.matches.empty()) {
    if (!files.source_features.empty() && !files.target_features.empty())
      raw.found = matched(read_features({files.source_features}), read_features({files.target_features}), options);
    return raw;
  }
  if (files.targets.empty() && is_own_table(files.matches)) {
    raw.found.emplace();
    raw.found->matches = read_matches(files.matches);
    raw.found->rows = raw.found->matches.size();
    for (int row = 0; row < raw.found->rows; ++row) raw.found->kept.push_back(row);
    raw.has_resolution = true;
    return raw;
  }
  if (files.targets.empty()) raw.found = match_archive(files.matches, options);
  if (raw.found) return raw;
  const bool both = !files.source.empty() && !files.target.empty();
  ForeignFiles foreign{files.matches, files.targets, nullptr, nullptr, options.first_index};
  Points source, target;
  if (both && files.targets.empty() && !is_archive(files.matches) && read_number_table(files.matches).width() < 6) {
    source = indexed_points(files.source);
    target = indexed_points(files.target);
    foreign.source = &source;
    foreign.target = &target;
  }
  raw.found = read_foreign_matches(foreign);
  return raw;
}

std::optional<RigidTransform> read_pair_truth(const PairFiles& files, const MatchImportOptions& options,
                                              ImportedPair& pair, const std::optional<RigidTransform>& in_file) {
  std::optional<RigidTransform> truth = in_file;
  if (!files.truth.empty()) {
    const StoredTransform stored = read_transform(files.truth);
    append(pair.notes, files.truth, stored.notes);
    truth = stored;
  } else if (!files.rotation.empty() && !files.translation.empty()) {
    truth = read_two(files.rotation, files.translation);
  } else if (files.pose) {
    truth = files.pose;
  }
  return truth && options.truth_is_inverse ? truth->inverse() : truth;
}

int count(const std::vector<bool>& labels) { return static_cast<int>(std::count(labels.begin(), labels.end(), true)); }

/// Says how the matches agree with the truth, and the labels with both.
void judge(const PairFiles& files, const MatchImportOptions& options, const ForeignMatches& found, ImportedPair& pair) {
  const CorrespondenceSet& matches = *pair.matches;
  pair.summary = std::to_string(matches.size()) + " matches";
  std::vector<bool> correct;
  if (pair.target_from_source) {
    const double limit_pr = options.correct_within ? *options.correct_within / matches.resolution : kCorrectPr;
    correct = label_correct(matches, *pair.target_from_source, limit_pr);
    pair.correct = count(correct);
    pair.summary += ", " + std::to_string(*pair.correct) + " correct within " +
                    (options.correct_within ? to_text(*options.correct_within) : to_text(kCorrectPr) + " pr") + " (" +
                    fixed(100.0 * *pair.correct / matches.size(), 2) + " %)";
    const int inverted = count(label_correct(matches, pair.target_from_source->inverse(), limit_pr));
    if (inverted > 3 && inverted > 2 * *pair.correct)
      pair.notes.push_back("the truth fits worse than its inverse, by which " + std::to_string(inverted) +
                           " matches are correct: see --truth-inverse");
  }
  std::vector<bool> labels = files.labels.empty() ? found.labels : read_labels(files.labels, found.rows);
  if (labels.empty()) return;
  int stated = 0, agreeing = 0;
  for (std::size_t i = 0; i < found.kept.size(); ++i) {
    const bool label = labels[static_cast<std::size_t>(found.kept[i])];
    stated += label;
    if (!correct.empty()) agreeing += label == correct[i];
  }
  pair.summary += ", " + std::to_string(stated) + " labelled correct";
  if (!correct.empty())
    pair.summary += " (" + std::to_string(agreeing) + " of " + std::to_string(matches.size()) + " labels agree)";
}

}  // namespace

double MatchImporter::spacing_of(const std::string& cloud) {
  const auto [place, is_new] = spacings_.try_emplace(cloud, 0);
  if (is_new) place->second = point_resolution(read_surface(cloud).vertices, options_.parallel);
  return place->second;
}

double MatchImporter::resolution_of(const PairFiles& files) {
  if (const auto length = parse_double(options_.resolution)) return *length;
  if (files.source.empty() || files.target.empty())
    throw IoError(
        files.matches.empty() ? files.source_features : files.matches, "",
        "the resolution is not known: no layout states it, and there are no two clouds to measure it on; "
        "expected --resolution LENGTH, the point spacing of the clouds in mesh units (in which 4 pr is the usual "
        "limit of a correct match), or --source and --target");
  return pair_resolution(options_.resolution, spacing_of(files.source), spacing_of(files.target));
}

ImportedPair MatchImporter::read(const PairFiles& files) {
  ImportedPair pair;
  RawPair raw = read_raw(files, options_);
  pair.target_from_source =
      read_pair_truth(files, options_, pair, raw.found ? raw.found->target_from_source : std::nullopt);
  if (!raw.found) {
    pair.summary = "two clouds, no matches";
    return pair;
  }
  append(pair.notes, files.matches.empty() ? files.source_features : files.matches, raw.found->notes);
  if (!raw.has_resolution) raw.found->matches.resolution = resolution_of(files);
  pair.matches = std::move(raw.found->matches);
  judge(files, options_, *raw.found, pair);
  return pair;
}

}  // namespace corral
