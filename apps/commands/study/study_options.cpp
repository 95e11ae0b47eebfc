// SPDX-License-Identifier: MIT
#include "apps/commands/study/study_options.h"

#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {

void add_study_options(CLI::App& command, StudyOptions& options) {
  command.add_option("experiments", options.experiments, "Names of experiments of the paper, or TOML files")
      ->type_name("EXPERIMENT")
      ->required();
  command.add_option("--data", options.data, "A data set (a folder with dataset.toml), or a folder of data sets")
      ->type_name("FOLDER")
      ->required();
  command
      .add_option("--methods", options.methods,
                  "Methods of other programs to be scored beside the groupers: methods.toml, which names the files of "
                  "their selections and poses (paper/README.md)")
      ->type_name("FILE");
  add_external_options(command, options.external);
  add_set_option(command, options.set);
  command.add_flag("--dense", options.dense, "Also refine on the whole surfaces, in columns of their own");
  add_pose_options(command, options.rows, options.select);
  command.add_flag("--confidence", options.confidence,
                   "Also the probability that each pose is right, estimated without the truth (paper/confidence.toml)");
}

StudyCall study_call(const StudyOptions& options) {
  load_plugins(options.external.plugins);
  StudyCall call = study_call(options.experiments, options.data);
  if (!options.methods.empty()) call.methods = {options.methods, read_file(options.methods)};
  call.options = parse_set(options.set);
  call.plugins = options.external.plugins;
  call.externals = external_methods(options.external);
  call.dense = options.dense;
  call.all_rows = options.rows == kRows[1];
  call.by_surface = options.select == kSelect[1];
  call.confidence = options.confidence;
  return call;
}

WorkList work_list_of(const StudyOptions& options) {
  try {
    return work_list_of(study_call(options));
  } catch (const InvalidInput& error) {  // of --set: the experiments themselves are checked where they are read
    throw UsageError(error.what());
  }
}

std::vector<std::string> words_of(const StudyOptions& options) {
  std::vector<std::string> words = options.experiments;
  words.insert(words.end(), {"--data", options.data});
  if (!options.methods.empty()) words.insert(words.end(), {"--methods", options.methods});
  const std::vector<std::string> external = words_of(options.external);
  words.insert(words.end(), external.begin(), external.end());
  for (const std::string& option : options.set) words.insert(words.end(), {"--set", option});
  if (options.dense) words.push_back("--dense");
  if (options.rows != kRows[0]) words.insert(words.end(), {"--rows", options.rows});
  if (options.confidence) words.push_back("--confidence");
  if (options.select != kSelect[0]) words.insert(words.end(), {"--select", options.select});
  return words;
}

}  // namespace corral
