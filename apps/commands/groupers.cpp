// SPDX-License-Identifier: MIT
// corral groupers: the methods and their options.
#include "apps/commands/commands.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"

namespace corral {
namespace {

struct Settings {
  bool json = false, markdown = false;
};

Json to_json(const Grouper& grouper) {
  Json options = Json::array();
  for (const OptionValue& option : grouper.options)
    options.push_back({{"name", option.name},
                       {"unit", option.unit},
                       {"default", typed(option.value)},
                       {"paper", option.paper.empty() ? Json(nullptr) : typed(option.paper)},
                       {"accepted", option.accepted},
                       {"meaning", option.meaning}});
  return {{"method", grouper.name},
          {"title", grouper.title},
          {"principle", grouper.principle},
          {"citation", grouper.citation},
          {"options", options}};
}

std::string to_markdown() {
  TextTable table({"method", "name", "keeps", "options (default)", "source"});
  for (const Grouper& grouper : groupers()) {
    std::string options;
    for (const OptionValue& option : grouper.options)
      options += (options.empty() ? "`" : ", `") + option.name + "` (" + option.value + ")";
    table.add({"`" + grouper.name + "`", grouper.title, grouper.principle, options, "[" + grouper.citation + "]"});
  }
  return table.markdown();
}

std::string to_text() {
  std::string text;
  for (const Grouper& grouper : groupers()) {
    text += grouper.name + "  " + grouper.title + ": " + grouper.principle + " [" + grouper.citation + "]\n";
    for (const OptionValue& option : grouper.options)
      text += "    " + option.name + " = " + option.value + (option.unit.empty() ? "" : " " + option.unit) +
              (option.paper.empty() ? "" : " (paper: " + option.paper + ")") + "  " + option.meaning + "; " +
              option.accepted + "\n";
  }
  return text;
}

int list(const Settings& settings) {
  Json json = Json::array();
  for (const Grouper& grouper : groupers()) json.push_back(to_json(grouper));
  if (settings.json)
    put("", json);
  else
    put("", settings.markdown ? to_markdown() : to_text());
  return kOk;
}

}  // namespace

void add_groupers(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("groupers", "The methods, their options and sources");
  auto settings = std::make_shared<Settings>();
  auto* json = command->add_flag("--json", settings->json, "As a JSON array");
  command->add_flag("--markdown", settings->markdown, "As the table of the README")->excludes(json);
  command->footer("Example:\n  corral groupers --json");
  command->callback([settings, &action] { action = [settings] { return list(*settings); }; });
}

}  // namespace corral
