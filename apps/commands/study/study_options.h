// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/commands/command_options.h"
#include "apps/pair/evaluate_pair.h"
#include "apps/study/study_call.h"

namespace corral {

/// What `evaluate`, `plan` and `submit` have in common: the study that is asked for, as typed.
struct StudyOptions {
  std::vector<std::string> experiments;
  std::string data;
  std::string methods;  ///< file; may be empty
  ExternalSettings external;
  std::vector<std::string> set;
  bool dense = false, confidence = false;
  std::string rows = kRows[0], select = kSelect[0];
};
void add_study_options(CLI::App& command, StudyOptions& options);

/// Throws UsageError for --set, IoError for what cannot be read.
StudyCall study_call(const StudyOptions& options);
WorkList work_list_of(const StudyOptions& options);

/// The words of the call behind the name of the command.
std::vector<std::string> words_of(const StudyOptions& options);

}  // namespace corral
