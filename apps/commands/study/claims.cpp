// SPDX-License-Identifier: MIT
// corral claims: which of the paper's findings a study confirms.
#include "apps/claims/claim_report.h"
#include "apps/commands/commands.h"
#include "apps/runtime/output.h"
#include "apps/runtime/workers.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> runs;
  std::string claims, prefix;
  bool json = false;
};

int judge(const Settings& settings) {
  const ClaimBook book = settings.claims.empty() ? built_in_claims() : read_claims(settings.claims);
  std::vector<StudyFolder> runs = read_runs(settings.runs);
  if (!settings.prefix.empty()) keep_methods_named(settings.prefix, runs);
  const std::vector<ClaimVerdict> verdicts = judge_claims(book, tables_of(runs), workers(0));
  if (!settings.json) {
    put("", claims_text(verdicts, book.slips));
    return kOk;
  }
  put("", Json{{"claims", claims_json(verdicts)}, {"slips", book.slips}});
  return kOk;
}

}  // namespace

void add_claims(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("claims", "Which of the paper's findings a study confirms");
  auto settings = std::make_shared<Settings>();
  command->add_option("studies", settings->runs, "Folders of 'corral evaluate'; several are combined")
      ->type_name("STUDY")
      ->required();
  command->add_option("--claims", settings->claims, "Claims of your own, as paper/claims.toml")->type_name("FILE");
  command
      ->add_option("--prefix", settings->prefix, "Judge only the methods whose names begin with this: plain-gc as gc")
      ->type_name("TEXT");
  command->add_flag("--json", settings->json, "As JSON");
  command->footer(
      "Examples:\n  corral claims runs/all\n  corral claims runs/all runs/time --json\n"
      "  corral claims runs/plain --prefix plain-");
  command->callback([settings, &action] { action = [settings] { return judge(*settings); }; });
}

}  // namespace corral
