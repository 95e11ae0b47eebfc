// SPDX-License-Identifier: MIT
// The program: one line of command, one answer. Everything it does is in commands/.
#include <exception>
#include <new>

#include "apps/commands/commands.h"
#include "apps/experiment/build_info.h"
#include "apps/report.h"
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Corral: which 3D correspondence grouper should I use, and how well does the surface align if I do?",
               "corral");
  app.require_subcommand(1);
  const corral::BuildInfo build = corral::build_info();
  app.set_version_flag("--version", "corral " + build.version + ", commit " + build.commit);
  app.footer(
      "Exit status: 0 done, 2 wrong usage, 3 bad input, 4 some parts failed and are recorded so, 1 anything else.\n"
      "Lengths with the suffix pr are in units of point resolution: the mean distance of a vertex to its nearest "
      "other.\n"
      "'corral COMMAND --help' has examples.");
  corral::Action action;
  corral::add_run(app, action);
  corral::add_info(app, action);
  corral::add_match(app, action);
  corral::add_group(app, action);
  corral::add_refine(app, action);
  corral::add_score(app, action);
  corral::add_groupers(app, action);
  corral::add_perturb(app, action);
  corral::add_scan(app, action);
  corral::add_triangulate(app, action);
  corral::add_evaluate(app, action);
  corral::add_dataset(app, action);
  corral::add_compare(app, action);
  corral::add_claims(app, action);
  corral::add_draw(app, action);
  corral::add_report(app, action);
  corral::add_align(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string first = argc > 1 ? argv[1] : "-";
    const auto is_first = [&](const CLI::App* command) { return command->get_name() == first; };
    if (first[0] != '-' && app.get_subcommands(is_first).empty()) {
      corral::say("corral: unknown command '" + first + "', expected one of those in corral --help");
      return corral::kUsage;
    }
    return app.exit(error) == 0 ? corral::kOk : corral::kUsage;
  }
  return run_action(action);
}
