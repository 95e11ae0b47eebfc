// SPDX-License-Identifier: MIT
// corral groupers, detectors, descriptors: what there is to choose from, with options and sources.
#include "apps/commands/commands.h"
#include "apps/runtime/output.h"
#include "apps/runtime/text_table.h"
#include "grouping/registry.h"
#include "kernel/surface/registry.h"

namespace corral {
namespace {

struct Settings {
  bool json = false, markdown = false;
};

/// A table and what its entries are called.
template <class Entry>
struct Listing {
  const std::vector<Entry>& entries;
  std::string key;    ///< of the name in JSON
  std::string title;  ///< of the first column in Markdown
  std::string verb;   ///< what an entry does, in Markdown
};

template <class Entry>
Json to_json(const Listing<Entry>& listing) {
  Json json = Json::array();
  for (const Entry& entry : listing.entries) {
    Json options = Json::array();
    for (const OptionValue& option : entry.options)
      options.push_back({{"name", option.name},
                         {"unit", option.unit},
                         {"default", typed(option.value)},
                         {"paper", option.paper.empty() ? Json(nullptr) : typed(option.paper)},
                         {"accepted", option.accepted},
                         {"meaning", option.meaning}});
    json.push_back({{listing.key, entry.name},
                    {"title", entry.title},
                    {"principle", entry.principle},
                    {"citation", entry.citation.empty() ? Json(nullptr) : Json(entry.citation)},
                    {"options", options}});
  }
  return json;
}

template <class Entry>
std::string to_markdown(const Listing<Entry>& listing) {
  TextTable table({listing.title, "name", listing.verb, "options (default)", "source"});
  for (const Entry& entry : listing.entries) {
    std::string options;
    for (const OptionValue& option : entry.options)
      options += (options.empty() ? "`" : ", `") + option.name + "` (" + option.value + ")";
    table.add({"`" + entry.name + "`", entry.title, entry.principle, options,
               entry.citation.empty() ? "" : "[" + entry.citation + "]"});
  }
  return table.markdown();
}

template <class Entry>
std::string to_text(const Listing<Entry>& listing) {
  std::string text;
  for (const Entry& entry : listing.entries) {
    text += entry.name + "  " + entry.title + ": " + entry.principle +
            (entry.citation.empty() ? "" : " [" + entry.citation + "]") + "\n";
    for (const OptionValue& option : entry.options)
      text += "    " + option.name + " = " + option.value + (option.unit.empty() ? "" : " " + option.unit) +
              (option.paper.empty() ? "" : " (paper: " + option.paper + ")") + "  " + option.meaning + "; " +
              option.accepted + "\n";
  }
  return text;
}

template <class Entry>
void add_listing(CLI::App& app, Action& action, const std::string& name, const Listing<Entry>& listing) {
  auto* command = app.add_subcommand(name, "The " + name + ", their options and sources");
  auto settings = std::make_shared<Settings>();
  auto* json = command->add_flag("--json", settings->json, "As a JSON array");
  command->add_flag("--markdown", settings->markdown, "As the table of the room's README.md")->excludes(json);
  command->footer("Example:\n  corral " + name + " --json");
  command->callback([settings, listing, &action] {
    action = [settings, listing]() -> int {
      if (settings->json)
        put("", to_json(listing));
      else
        put("", settings->markdown ? to_markdown(listing) : to_text(listing));
      return kOk;
    };
  });
}

}  // namespace

void add_tables(CLI::App& app, Action& action) {
  add_listing<Grouper>(app, action, "groupers", {groupers(), "method", "grouper", "keeps"});
  add_listing<Detector>(app, action, "detectors", {detectors(), "detector", "detector", "finds"});
  add_listing<Descriptor>(app, action, "descriptors", {descriptors(), "descriptor", "descriptor", "holds"});
}

}  // namespace corral
