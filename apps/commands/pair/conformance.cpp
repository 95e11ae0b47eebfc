// SPDX-License-Identifier: MIT
// corral conformance: groupers against what every grouper promises.
#include <algorithm>

#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/commands/pair/pair_run.h"
#include "apps/pair/conformance.h"
#include "apps/pair/external_method.h"
#include "apps/runtime/output.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/text_table.h"
#include "io/disk/file.h"
#include "io/matches/matches_file.h"

namespace corral {
namespace {

struct Settings {
  std::string methods, output;
  ExternalSettings external;
  std::vector<std::string> set;
  bool json = false;
};

struct Method {
  std::string name;
  GroupFunction group;
};

std::vector<Method> methods_of(const Settings& settings) {
  if (settings.methods.empty() && settings.external.empty())
    throw UsageError("expected names of groupers, --external or --plugin");
  load_plugins(settings.external.plugins);
  std::vector<Method> methods;
  const std::vector<std::string> names =
      with_plugins(settings.methods.empty() ? std::vector<std::string>() : method_names(settings.methods));
  const OptionsByName options = parse_set(settings.set);
  require_in_use(options, names);
  for (const std::string& name : names) methods.push_back({name, configure_grouper(name, options).group});
  for (const ExternalMethod& external : external_methods(settings.external))
    methods.push_back({external.name, [external](const CorrespondenceSet& matches) {
                         return call_external(external, matches).found;
                       }});
  return methods;
}

int check(const Settings& settings) {
  const std::vector<Method> methods = methods_of(settings);
  if (!settings.output.empty()) make_folder(settings.output);
  std::vector<FileContent> files;
  std::vector<Json> rows;
  bool is_broken = false;
  {
    Progress progress(static_cast<double>(methods.size()));
    for (const Method& method : methods) {
      progress.begin(method.name);
      for (const ConformanceCheck& check : check_conformance(method.group)) {
        std::string file;
        // A table that is not finite could not be read again.
        if (check.table && check.table->target_points.allFinite() && !settings.output.empty()) {
          std::string name = check.name;
          std::replace(name.begin(), name.end(), ' ', '-');
          file = settings.output + "/" + method.name + "-" + name + ".csv";
          files.push_back({file, matches_text(*check.table)});
        }
        is_broken = is_broken || check.holds == false;
        rows.push_back({{"method", method.name},
                        {"check", check.name},
                        {"holds", json_or_null(check.holds)},
                        {"verdict", !check.holds   ? ""
                                    : *check.holds ? "holds"
                                                   : "broken"},
                        {"text", check.text},
                        {"table", file.empty() ? Json(nullptr) : Json(file)}});
      }
    }
  }
  write_files(files);
  if (settings.json)
    put("", Json(rows));
  else
    put("", table_text(rows,
                       {{"grouper", "method"}, {"check", "check"}, {"verdict", "verdict"}, {"what it does", "text"}}));
  return is_broken ? kPartial : kOk;
}

}  // namespace

void add_conformance(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "conformance", "Check groupers, ours or an external program, against what every grouper promises");
  auto settings = std::make_shared<Settings>();
  command->add_option("methods", settings->methods, "all, paper (those of 2017), or names between commas")
      ->type_name("NAMES");
  add_external_options(*command, settings->external);
  add_set_option(*command, settings->set);
  command->add_option("-o,--output", settings->output, "Folder for the tables of matches where a check is broken")
      ->type_name("FOLDER");
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "A grouper must accept a table of 0 to 3 matches; return rows of the table in ascending order; refuse or leave out a match\n"
      "that is not finite; return the same rows when it is called again, when the rows are shuffled, when the unit of length changes\n"
      "and when the target is moved; and solve an easy table. The exit status is 4 if a check fails. RANSAC and ST fail the\n"
      "check of the order: RANSAC draws by row number, and ST breaks ties by it.\n"
      "Examples:\n"
      "  corral conformance gc,ransac\n"
      "  corral conformance --external \"mine=python3 mine.py {matches} {group}\" -o broken");
  command->callback([settings, &action] { action = [settings] { return check(*settings); }; });
}

}  // namespace corral
