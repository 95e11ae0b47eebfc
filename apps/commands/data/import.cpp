// SPDX-License-Identifier: MIT
// corral import: tables of matches of other programs.
#include <filesystem>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/dataset/import_matches.h"
#include "apps/runtime/output.h"
#include "apps/runtime/workers.h"
#include "io/array/number_table.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"
#include "io/pose/transform_file.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

struct Settings {
  ImportFolderOptions options;  // `folder` is the first input, be it a folder or a file
  PairFiles pair;
  std::string truth_output;
  std::optional<int> first_index;
  int threads = 0;
};

void check(const Settings& settings) {
  const std::string& rule = settings.options.resolution;
  const auto length = parse_double(rule);
  if (rule != "mean" && rule != "source" && rule != "target" && !(length && *length > 0 && *length < 1e300))
    throw UsageError("--resolution " + rule + ": expected mean, source, target, or a length above zero in mesh units");
  if (settings.options.correct_within && !(*settings.options.correct_within > 0))
    throw UsageError("--correct-within: expected a length above zero in mesh units");
  if (settings.pair.source.empty() != settings.pair.target.empty())
    throw UsageError("--source and --target: expected both clouds or none");
}

int import_folder(const Settings& settings) {
  if (!settings.pair.targets.empty() || !settings.pair.truth.empty() || !settings.pair.labels.empty() ||
      !settings.pair.source.empty() || !settings.truth_output.empty())
    throw UsageError(settings.options.folder +
                     " is a folder: its truths, labels and clouds are found by their names, expected none of TARGETS, "
                     "--truth, --labels, --source, --target and --truth-output");
  if (settings.options.output.empty()) throw UsageError("-o: expected the folder of the new data set");
  std::vector<std::string> lines;
  {
    Progress progress(1);
    lines = import_match_folder(settings.options, progress);
  }
  for (const std::string& line : lines) say(line);
  return kOk;
}

int import_table(const Settings& settings) {
  if (!settings.options.layout.empty())
    throw UsageError("--layout is for folders: what a file holds is told by its content");
  const PairFiles& files = settings.pair;
  keep_inputs({split_array_name(files.matches).file, split_array_name(files.targets).file, files.truth, files.labels,
               files.source, files.target},
              {settings.options.output, settings.truth_output});
  for (const std::string& output : {settings.options.output, settings.truth_output})
    if (!output.empty()) check_writable(output);
  const ImportedPair pair = MatchImporter(settings.options).read(files);
  for (const std::string& note : pair.notes) say("note: " + note);
  if (!settings.truth_output.empty() && !pair.target_from_source)
    throw IoError(files.matches, "", "holds no true pose and none is named, expected one for --truth-output");
  if (!settings.truth_output.empty()) put(settings.truth_output, transform_text(*pair.target_from_source));
  put(settings.options.output, matches_text(*pair.matches));
  say(pair.summary);
  return kOk;
}

int import_matches(Settings settings) {
  check(settings);
  settings.options.first_index = settings.first_index;
  settings.options.parallel = workers(settings.threads);
  if (std::filesystem::is_directory(settings.options.folder)) return import_folder(settings);
  settings.pair.matches = settings.options.folder;
  return import_table(settings);
}

constexpr const char* kFooter =
    "A file: rows of six coordinates, pairs of indices beside two clouds, two files of points, .npy or .npz (FILE:NAME "
    "names an\narray). A folder becomes a data set; its layout is one of\n"
    "  mac      [A+B@]corr[_DESCRIPTOR].txt or corr_data.txt, with label.txt, GTmat.txt and the clouds A and B\n"
    "  points   ID_kpts_src.txt, ID_kpts_dst.txt, ID_trans.txt, ID_pts_src.ply (TurboReg); v1.csv, v2.csv, R_gt.csv, "
    "t_gt.csv (TEASER++)\n"
    "  npz      one .npz for each pair (SC2-PCR, PointDSC, GeoTransformer)\n"
    "  tcf      A_B_top3.match, A-B.pose, A*.pcd, B*.pcd\n"
    "  3dmatch  gt.log and gt.info of scenes, with cloud_bin_N.ply, or features cloud_bin_N_fcgf.npz, which are "
    "matched\n"
    "  kitti    poses SEQUENCE_SOURCE_TARGET.npy beside sequences/NN/velodyne/*.bin\n"
    "  corral   NAME.matches.csv, NAME.xf\n"
    "Examples:\n"
    "  corral import matches corr.txt --truth GTmat.txt --labels label.txt --source a.ply --target b.ply -o "
    "matches.csv\n"
    "  corral import matches s2_s1_top3.match --truth s2-s1.pose --resolution 0.06 --correct-within 0.3 -o "
    "matches.csv\n"
    "  corral import matches kpts_src.txt kpts_dst.txt --resolution 0.25 -o matches.csv\n"
    "  corral import matches ~/3DLoMatch --layout mac -o data/lomatch";

}  // namespace

void add_import(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("import", "Matches of other programs: a file becomes a table, a folder a data set");
  command->require_subcommand(1);
  command = command->add_subcommand("matches", "A table of matches, or a folder of them");
  auto settings = std::make_shared<Settings>();
  ImportFolderOptions& options = settings->options;
  command->add_option("input", options.folder, "Table, source points, or folder")->type_name("PATH")->required();
  command->add_option("targets", settings->pair.targets, "Target points, if the first file has the source points only")
      ->type_name("FILE");
  command->add_option("-o,--output", options.output, "Where the table goes (default: standard output), or the data set")
      ->type_name("PATH");
  command
      ->add_option("--truth", settings->pair.truth,
                   "True target_from_source, in any layout of 'corral transform', or .npy")
      ->type_name("FILE[:KEY]");
  command->add_flag("--truth-inverse", options.truth_is_inverse, "Poses here are source_from_target: take the inverse");
  command->add_option("--truth-output", settings->truth_output, "Where the true pose goes, source to target (4x4)")
      ->type_name("FILE");
  command
      ->add_option("--labels", settings->pair.labels, "Which matches are said to be correct: 0 or 1 for each, or rows")
      ->type_name("FILE");
  command->add_option("--source", settings->pair.source, "Cloud of the source: for indices, and to measure pr")
      ->type_name("FILE");
  command->add_option("--target", settings->pair.target, "Cloud of the target")->type_name("FILE");
  command
      ->add_option("--resolution", options.resolution,
                   "pr: mean, source or target of the two clouds, or a length in mesh units where there are none")
      ->capture_default_str();
  command->add_option("--correct-within", options.correct_within,
                      "A match is correct up to this distance in mesh units (default: 4 pr)");
  command
      ->add_option("--first-index", settings->first_index,
                   "First index, 0 or 1 (default: 1 if no index is 0 and one equals the number of points, else 0)")
      ->check(CLI::IsMember({0, 1}));
  command->add_flag("--mutual", options.matching.mutual,
                    "Features: keep a match only if each is the nearest of the other");
  command->add_option("--layout", options.layout, "Layout of the folder (default: the one that is there)")
      ->check(CLI::IsMember(match_layouts()));
  add_threads(*command, settings->threads);
  command->footer(kFooter);
  command->callback([settings, &action] { action = [settings] { return import_matches(*settings); }; });
}

}  // namespace corral
