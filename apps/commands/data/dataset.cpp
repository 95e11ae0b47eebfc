// SPDX-License-Identifier: MIT
// corral dataset: check, list and measure data sets; dataset_make.cpp and dataset_import.cpp make and import them.
#include <algorithm>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/dataset/check_dataset.h"
#include "apps/dataset/measure_dataset.h"
#include "apps/dataset/published_sets.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "io/text/csv_file.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

struct CheckSettings {
  std::string folder;
  int threads = 0;
  bool json = false;
};

int check(const CheckSettings& settings) {
  const Dataset dataset = read_dataset(settings.folder);
  std::vector<Finding> findings;
  {
    Progress progress(static_cast<double>(dataset.pairs.size()));
    findings = check_dataset(dataset, workers(settings.threads), progress);
  }
  if (settings.json) {
    Json list = Json::array();
    for (const Finding& each : findings)
      list.push_back(
          {{"pair", each.pair}, {"file", each.file}, {"problem", each.problem}, {"is_error", each.is_error}});
    put("", Json{{"name", dataset.name}, {"pairs", dataset.pairs.size()}, {"findings", list}});
  } else {
    std::string text;
    for (const Finding& each : findings)
      text += each.pair + (each.file.empty() ? "" : "/" + each.file) + ": " + (each.is_error ? "" : "note: ") +
              each.problem + "\n";
    put("", text);
  }
  const auto errors =
      std::count_if(findings.begin(), findings.end(), [](const Finding& finding) { return finding.is_error; });
  const auto notes = static_cast<std::ptrdiff_t>(findings.size()) - errors;
  say(settings.folder + ": " + std::to_string(dataset.pairs.size()) + " pairs, " +
      (errors == 0 ? "no problems" : std::to_string(errors) + (errors == 1 ? " problem" : " problems")) +
      (notes == 0 ? "" : ", " + std::to_string(notes) + (notes == 1 ? " note" : " notes")));
  return errors == 0 ? kOk : kBadInput;
}

Json to_json(const PublishedSet& set) {
  Json known = Json::array();
  for (const KnownFile& file : set.known)
    known.push_back({{"name", file.name}, {"package", file.package}, {"sha256", file.sha256}});
  return {{"name", set.name},     {"title", set.title}, {"origin", set.origin},
          {"place", set.place},   {"terms", set.terms}, {"citation", set.citation},
          {"layout", set.layout}, {"files", set.files}, {"known_files", known},
          {"use", set.use}};
}

std::string in_words(const PublishedSet& set) {
  std::string text = set.name + ": " + set.title + "\n";
  const auto line = [&](const std::string& key, const std::string& value) {
    text += "  " + key + std::string(10 - key.size(), ' ') + value + "\n";
  };
  line("origin", set.origin);
  line("from", set.place);
  line("terms", set.terms);
  for (const std::string& work : set.citation) line("cite", work);
  for (const std::string& entry : set.layout) line("layout", entry);
  for (const std::string& file : set.files) line("file", file);
  for (const KnownFile& file : set.known) line("sha256", file.sha256 + "  " + file.name + " (" + file.package + ")");
  line("use", set.use);
  return text + "\n";
}

int list(bool json) {
  Json all = Json::array();
  std::string text;
  for (const PublishedSet& set : published_sets()) {
    all.push_back(to_json(set));
    text += in_words(set);
  }
  if (json)
    put("", all);
  else
    put("", text);
  return kOk;
}

struct MeasureSettings {
  std::string folder, output;
  int threads = 0;
  bool with_matches = false, write = false, json = false;
};

std::string cell(const std::optional<double>& value) { return value ? to_text(*value) : ""; }

std::string measures_csv(const Dataset& dataset, const std::vector<PairMeasures>& measured) {
  CsvTable table{{"pair"}, {}};
  table.header.insert(table.header.end(), measure_names().begin(), measure_names().end());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    table.rows.push_back({dataset.pairs[i].name});
    for (std::size_t place = 0; place < measure_names().size(); ++place)
      table.rows.back().push_back(cell(measure(measured[i], place)));
  }
  return csv_text(table);
}

/// Writes the measured values to the attributes of their names; existing values are published ones, and stay.
void write_attributes(Dataset dataset, const std::vector<PairMeasures>& measured) {
  for (std::size_t place = 0; place < measure_names().size(); ++place) {
    const auto has_it = [&](const PairMeasures& each) { return measure(each, place).has_value(); };
    if (std::none_of(measured.begin(), measured.end(), has_it)) continue;
    auto column = std::find(dataset.attributes.begin(), dataset.attributes.end(), measure_names()[place]);
    const auto at = static_cast<std::size_t>(column - dataset.attributes.begin());
    if (column == dataset.attributes.end()) {
      dataset.attributes.push_back(measure_names()[place]);
      for (DatasetPair& pair : dataset.pairs) pair.attributes.emplace_back();
    }
    for (std::size_t i = 0; i < measured.size(); ++i)
      if (dataset.pairs[i].attributes[at].empty())
        dataset.pairs[i].attributes[at] = fixed(measure(measured[i], place), 2);
  }
  write_file(dataset.path("pairs.csv"), pairs_csv_text(dataset));
}

Json to_json(const Dataset& dataset, const std::vector<PairMeasures>& measured) {
  Json pairs = Json::array(), histograms = Json::object();
  for (std::size_t i = 0; i < measured.size(); ++i) pairs.push_back({{"pair", dataset.pairs[i].name}});
  for (std::size_t place = 0; place < measure_names().size(); ++place) {
    std::vector<double> values;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const auto value = measure(measured[i], place);
      pairs[i][measure_names()[place]] = json_or_null(value);
      if (value) values.push_back(*value);
    }
    histograms[measure_names()[place]] = {{"bin_percent", 10}, {"counts", histogram(values)}};
  }
  return {{"name", dataset.name}, {"pairs", pairs}, {"histograms", histograms}};
}

std::string histograms_text(const std::vector<PairMeasures>& measured) {
  std::string text;
  for (std::size_t place = 0; place < measure_names().size(); ++place) {
    std::vector<double> values;
    for (const PairMeasures& each : measured)
      if (const auto value = measure(each, place)) values.push_back(*value);
    text += histogram_text(measure_names()[place], values);
  }
  return text;
}

int measure_all(const MeasureSettings& settings) {
  const Dataset dataset = read_dataset(settings.folder);
  std::vector<std::string> inputs = {dataset.path("pairs.csv"), dataset.path("dataset.toml")};
  for (const DatasetPair& pair : dataset.pairs)
    for (const std::string& file : pair.files())
      if (!file.empty()) inputs.push_back(dataset.path(file));
  keep_inputs(inputs, {settings.output});
  if (!settings.output.empty()) check_writable(settings.output);
  if (settings.write) check_writable(dataset.path("pairs.csv"));
  std::vector<PairMeasures> measured;
  {
    Progress progress(static_cast<double>(dataset.pairs.size()));
    measured = measure_dataset(dataset, settings.with_matches, workers(settings.threads), progress);
  }
  if (!settings.output.empty()) write_file(settings.output, measures_csv(dataset, measured));
  if (settings.write) write_attributes(dataset, measured);
  if (settings.json)
    put("", to_json(dataset, measured));
  else
    put("", histograms_text(measured));
  const auto lost = std::count_if(measured.begin(), measured.end(), [](const auto& each) { return !each.overlap; });
  if (lost == 0) return kOk;
  say(std::to_string(lost) + " of " + std::to_string(measured.size()) +
      " pairs could not be measured: 'corral dataset check' says why; a pair without a truth cannot be");
  return kPartial;
}

void add_check(CLI::App& dataset, Action& action) {
  auto* command = dataset.add_subcommand("check", "The problems of a data set, file by file");
  auto settings = std::make_shared<CheckSettings>();
  command->add_option("folder", settings->folder, "Folder with dataset.toml and pairs.csv")->required();
  add_threads(*command, settings->threads);
  command->add_flag("--json", settings->json, "The findings as JSON on standard output");
  command->footer(
      "Reports files that are missing or unreadable, truths that are not rigid or fit better inverted or not at all,\n"
      "wrong units, unusual resolutions and duplicate pairs, in one line each; the exit status is 3 if there are any.\n"
      "Example:\n  corral dataset check data/b3r");
  command->callback([settings, &action] { action = [settings] { return check(*settings); }; });
}

void add_list(CLI::App& dataset, Action& action) {
  auto* command =
      dataset.add_subcommand("list", "The published sets: origin, terms, layout, and where to ask for them");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "As JSON");
  command->footer("Example:\n  corral dataset list");
  command->callback([json, &action] { action = [json] { return list(*json); }; });
}

void add_measure(CLI::App& dataset, Action& action) {
  auto* command = dataset.add_subcommand("measure", "Overlap, occlusion and clutter of every pair, in percent");
  auto settings = std::make_shared<MeasureSettings>();
  command->add_option("folder", settings->folder, "Folder with dataset.toml and pairs.csv")->required();
  command->add_option("-o,--output", settings->output, "A table of all pairs (CSV)")->type_name("FILE");
  command->add_flag(
      "--matches", settings->with_matches,
      "Also match every pair: share of correct matches (4 pr), and share of these whose frames agree (10 degrees)");
  command->add_flag("--write", settings->write, "Write the values to pairs.csv where they are empty there");
  add_threads(*command, settings->threads);
  command->add_flag("--json", settings->json, "Values and histograms as JSON on standard output");
  command->footer(
      "overlap: vertices with a vertex of the other surface within 2 pr; the smaller of the two counts over the "
      "smaller\n"
      "number of vertices. occlusion: 1 - share of the source's area that lies within 2 pr of the target; clutter: "
      "the\n"
      "same for the target.\n"
      "Examples:\n  corral dataset measure data/mine --output measured.csv\n"
      "  corral dataset measure data/mine --matches --write");
  command->callback([settings, &action] { action = [settings] { return measure_all(*settings); }; });
}

}  // namespace

void add_dataset(CLI::App& app, Action& action) {
  auto* dataset = app.add_subcommand("dataset", "Data sets: check, list, measure, make, import");
  dataset->require_subcommand(1);
  add_check(*dataset, action);
  add_list(*dataset, action);
  add_measure(*dataset, action);
  add_dataset_make(*dataset, action);
  add_dataset_import(*dataset, action);
}

}  // namespace corral
