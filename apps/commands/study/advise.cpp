// SPDX-License-Identifier: MIT
// corral advise: which grouper to use on these data.
#include <algorithm>
#include <filesystem>

#include "apps/advise/advise.h"
#include "apps/commands/command_options.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> data;
  AdviceOptions advice;
  std::string prefer = kPreferences[0];
  std::vector<std::string> set;
  bool json = false;
};

/// A folder is a data set; tables of matches are pairs of their own; two other files are one pair of surfaces.
Dataset dataset_of(const std::vector<std::string>& data) {
  if (data.size() == 1 && std::filesystem::is_directory(data.front())) return read_dataset(data.front());
  Dataset dataset;
  const auto is_table = [](const std::string& file) { return std::filesystem::path(file).extension() == ".csv"; };
  if (std::all_of(data.begin(), data.end(), is_table)) {
    for (const std::string& file : data)
      dataset.pairs.push_back({std::filesystem::path(file).stem().string(), "", "", "", {}, file});
    return dataset;
  }
  if (data.size() != 2) throw UsageError("expected a data set (a folder), two surfaces, or tables of matches (.csv)");
  dataset.pairs.push_back({"pair", data[0], data[1], "", {}});
  return dataset;
}

int give_advice(Settings settings) {
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, settings.advice.matching.in_use());
  settings.advice.matching.options = surface_part(options);
  check_usage(settings.advice.matching);
  if (settings.advice.sample < 1) throw UsageError("--sample: expected at least 1");
  if (!(settings.advice.budget_ms > 0)) throw UsageError("--budget-ms: expected a time above 0");
  settings.advice.prefer = static_cast<Preference>(
      std::find(kPreferences.begin(), kPreferences.end(), settings.prefer) - kPreferences.begin());
  const Dataset dataset = dataset_of(settings.data);
  Advice advice;
  {
    Progress progress(1);
    advice =
        advise(dataset, settings.advice, [&](const std::string& step, double share) { progress.begin(step, share); });
  }
  for (const std::string& failure : advice.facts.failures) say("warning: " + failure);
  if (settings.json)
    put("", to_json(advice));
  else
    put("", advice_text(advice, settings.advice));
  return kOk;
}

}  // namespace

void add_advise(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("advise", "Which grouper to use on these data, tried on a sample of them");
  auto settings = std::make_shared<Settings>();
  command
      ->add_option("data", settings->data,
                   "A data set (a folder with dataset.toml), two surfaces, or tables of matches")
      ->type_name("FILE")
      ->required();
  command->add_option("--sample", settings->advice.sample, "Most pairs that are tried, evenly spaced")
      ->capture_default_str();
  command->add_option("--budget-ms", settings->advice.budget_ms, "Longest median time per pair");
  command->add_option("--prefer", settings->prefer, "What matters most")
      ->check(CLI::IsMember(std::vector<std::string>(kPreferences.begin(), kPreferences.end())))
      ->type_name("success|precision|recall")
      ->capture_default_str();
  command->add_flag("--json", settings->json, "As JSON");
  add_match_options(*command, settings->advice.matching);
  add_set_option(*command, settings->set);
  command->footer(
      "Every grouper, 'auto' and 'register' are run on the sample. A pair without a truth is judged by the pose of 'register' where\n"
      "its probability is 0.9 or more, and is left out otherwise. Some pairs are matched again with denser keypoints\n"
      "and with other detectors and descriptors, to see whether that helps more than another grouper.\n"
      "Examples:\n"
      "  corral advise my-scans\n"
      "  corral advise matches/*.csv --budget-ms 50 --prefer recall");
  command->callback([settings, &action] { action = [settings] { return give_advice(*settings); }; });
}

}  // namespace corral
