// SPDX-License-Identifier: MIT
#include "apps/study/study_call.h"

#include <algorithm>
#include <filesystem>

#include "apps/pair/methods.h"
#include "apps/study/experiment_options.h"
#include "apps/study/methods_file.h"
#include "kernel/error.h"

namespace corral {

namespace {

std::vector<ForeignMethod> foreign_methods(const std::vector<ExternalMethod>& externals) {
  std::vector<ForeignMethod> methods;
  for (const ExternalMethod& external : externals)
    methods.push_back({external.name, external.name, "", "", "", {}, std::make_shared<ExternalMethod>(external)});
  return methods;
}

}  // namespace

StudyCall study_call(const std::vector<std::string>& experiments, const std::string& data) {
  StudyCall call;
  call.data = data;
  for (const std::string& name : experiments) call.experiments.push_back({name, experiment_text(name)});
  return call;
}

WorkList work_list_of(const StudyCall& call) {
  for (const std::string& file : call.plugins)
    if (!is_loaded_plugin(file))
      throw IoError(file, "", "is a plug-in that the study was made with: give it by --plugin, if you trust it");
  std::vector<Experiment> experiments;
  for (const auto& [path, text] : call.experiments) {
    experiments.push_back(parse_experiment(path, text));
    Experiment& experiment = experiments.back();
    std::vector<std::string>& names = experiment.info.methods;
    for (const std::string& method : plugin_methods())
      if (std::find(names.begin(), names.end(), method) == names.end()) names.push_back(method);
    experiment.dense = experiment.dense || call.dense;
    experiment.all_rows = experiment.all_rows || call.all_rows;
    experiment.by_surface = experiment.by_surface || call.by_surface;
    experiment.confidence = experiment.confidence || call.confidence;
    override_options(experiment, call.options);
    if (call.methods) add_methods(experiment, parse_methods(call.methods->path, call.methods->text));
    add_methods(experiment, foreign_methods(call.externals));
    if (experiment.info.methods.empty()) throw IoError(path, "groupers", "is empty, expected at least one grouper");
  }
  return make_work_list(std::move(experiments), call.data);
}

Json to_json(const StudyCall& call) {
  const auto absolute = [](const std::string& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  };
  Json experiments = Json::array(), externals = Json::array(), plugins = Json::array(), methods = nullptr;
  for (const std::string& file : call.plugins) plugins.push_back(absolute(file));
  for (const ExternalMethod& external : call.externals)
    externals.push_back({{"name", external.name},
                         {"command", external.command},
                         {"timeout_s", external.timeout_s},
                         {"memory_bytes", external.memory_bytes}});
  if (call.methods) methods = {{"path", absolute(call.methods->path)}, {"text", call.methods->text}};
  for (const auto& [path, text] : call.experiments) experiments.push_back({{"path", path}, {"text", text}});
  return {{"experiments", experiments},    {"methods", methods},
          {"data", absolute(call.data)},   {"options", call.options},
          {"dense", call.dense},           {"all_rows", call.all_rows},
          {"by_surface", call.by_surface}, {"confidence", call.confidence},
          {"externals", externals},        {"plugins", plugins}};
}

StudyCall study_call_of(const Json& json) {
  StudyCall call;
  for (const Json& each : json.at("experiments")) call.experiments.push_back({each.at("path"), each.at("text")});
  const Json& methods = json.at("methods");
  if (!methods.is_null()) call.methods = {methods.at("path"), methods.at("text")};
  call.data = json.at("data");
  call.options = json.at("options").get<OptionsByName>();
  for (const Json& each : json.at("externals"))
    call.externals.push_back({each.at("name"), each.at("command"), each.at("timeout_s"), each.at("memory_bytes")});
  call.plugins = json.at("plugins").get<std::vector<std::string>>();
  call.dense = json.at("dense");
  call.all_rows = json.at("all_rows");
  call.by_surface = json.at("by_surface");
  call.confidence = json.at("confidence");
  return call;
}

}  // namespace corral
