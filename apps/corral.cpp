// SPDX-License-Identifier: MIT
// The main program: parses the command line and calls one of commands/.
#include <exception>
#include <new>

#include "apps/commands/commands.h"
#include "apps/runtime/build_info.h"
#include "apps/runtime/output.h"
#include "io/text/toml_file.h"
#include "kernel/error.h"

namespace {

int run_action(const corral::Action& action) {
  try {
    return action();
  } catch (const corral::UsageError& error) {
    corral::say(std::string("corral: ") + error.what());
    return corral::kUsage;
  } catch (const corral::IoError& error) {
    corral::say(std::string("corral: ") + error.what());
    return corral::kBadInput;
  } catch (const corral::InvalidInput& error) {
    corral::say(std::string("corral: ") + error.what());
    return corral::kBadInput;
  } catch (const std::bad_alloc&) {
    corral::say("corral: out of memory");
    return corral::kOtherFailure;
  } catch (const std::exception& error) {
    corral::say(std::string("corral: ") + error.what());
    return corral::kOtherFailure;
  }
}

/// An error message if a word in the place of a command is not one; else empty.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::string path = "corral";
  for (int i = 1; i < argc && command->get_require_subcommand_min() > 0 && argv[i][0] != '-'; ++i) {
    const CLI::App* next = nullptr;
    std::vector<std::string> names;
    for (const CLI::App* each : command->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(each->get_name());
      if (each->get_name() == argv[i]) next = each;
    }
    if (!next) {
      const std::string nearest = corral::nearest_name(argv[i], names);
      return "unknown command '" + std::string(argv[i]) + "', " +
             (nearest.empty() ? "expected one of those in " : "did you mean '" + nearest + "'? See ") + path +
             " --help";
    }
    command = next;
    path += " " + next->get_name();
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Corral: which 3D correspondence grouper should I use, and how well does the surface align if I do?",
               "corral");
  app.require_subcommand(1);
  const corral::BuildInfo build = corral::build_info();
  app.set_version_flag("--version", "corral " + build.version + ", commit " + build.commit);
  app.footer(
      "Exit status: 0 done, 2 wrong usage, 3 bad input, 4 some parts failed and are recorded as failed, 1 anything else.\n"
      "Lengths with the suffix pr are in units of point resolution: the mean distance of a vertex to its nearest other vertex.\n"
      "'corral COMMAND --help' has examples.");
  corral::Action action;
  corral::add_run(app, action);
  corral::add_register(app, action);
  corral::add_info(app, action);
  corral::add_match(app, action);
  corral::add_import(app, action);
  corral::add_group(app, action);
  corral::add_refine(app, action);
  corral::add_score(app, action);
  corral::add_tables(app, action);
  corral::add_conformance(app, action);
  corral::add_perturb(app, action);
  corral::add_scan(app, action);
  corral::add_transform(app, action);
  corral::add_triangulate(app, action);
  corral::add_evaluate(app, action);
  corral::add_plan(app, action);
  corral::add_advise(app, action);
  corral::add_calibrate(app, action);
  corral::add_merge(app, action);
  corral::add_verify(app, action);
  corral::add_submit(app, action);
  corral::add_scoreboard(app, action);
  corral::add_dataset(app, action);
  corral::add_compare(app, action);
  corral::add_claims(app, action);
  corral::add_reproduce(app, action);
  corral::add_draw(app, action);
  corral::add_report(app, action);
  corral::add_align(app, action);
  corral::add_manual(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_command(app, argc, argv);
    if (!unknown.empty()) {
      corral::say("corral: " + unknown);
      return corral::kUsage;
    }
    return app.exit(error) == 0 ? corral::kOk : corral::kUsage;
  }
  return run_action(action);
}
