// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/runtime/json.h"
#include "apps/study/work_list.h"

namespace corral {

/// What a study is asked for, whole: from it the same work list follows wherever the data sets are.
struct StudyCall {
  struct NamedText {
    std::string path, text;
  };
  std::vector<NamedText> experiments;     ///< as read: files, or built-in experiments
  std::optional<NamedText> methods;       ///< methods of other programs, for every experiment
  std::string data;                       ///< a data set, or a folder of data sets
  OptionsByName options;                  ///< of --set
  std::vector<std::string> plugins;       ///< of --plugin
  std::vector<ExternalMethod> externals;  ///< of --external
  bool dense = false, all_rows = false, by_surface = false, confidence = false;  ///< as of Experiment, for all of them
};

/// Reads the experiments (files, or names of built-in ones). Throws IoError.
StudyCall study_call(const std::vector<std::string>& experiments, const std::string& data);

/// Plug-ins are not loaded here: the call may come from a study of somebody else.
/// Throws IoError (an experiment or a manifest of the data, a plug-in that is not loaded), InvalidInput (options that the experiments do not accept).
WorkList work_list_of(const StudyCall& call);

/// The same call with the absolute path of its data, as it is kept beside results; and back. Throws Json::exception.
Json to_json(const StudyCall& call);
StudyCall study_call_of(const Json& json);

}  // namespace corral
