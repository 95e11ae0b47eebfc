// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "apps/results/study_folder.h"

namespace corral::testing {

/// What a name may be that somebody else has chosen. Where one of them is run, it sets window.hacked.
inline std::vector<std::string> hostile_names() {
  return {"<script>window.hacked=1</script>",
          "</script><script>window.hacked=1</script>",
          "<img src=x onerror=window.hacked=1>",
          "\"'><svg onload=window.hacked=1>",
          "<!--<script>",
          "javascript:window.hacked=1",
          "`touch hacked`$(touch hacked);touch hacked",
          "\\input{hacked}\\write18{touch hacked}",
          "'; system('touch hacked'); print '",
          "../../hacked",
          "a\tb\nc\x01\x1b[31m\x7f",
          "\xff\xfe\xc0\x80",
          "__proto__",
          std::string(10240, '<')};
}

/// A study in which all of them together are the name of a pair, a method, a scene and a cause.
inline StudyFolder with_hostile_names(StudyFolder study, const std::string& pair) {
  std::string all;
  for (const std::string& name : hostile_names()) all += name;
  std::string& method = study.experiments[0].methods[0];
  for (StudyRecord& record : study.records) {
    if (record.method == method) record.method = all;
    if (record.pair == pair) record.pair = all;
    record.scene = record.status.cause = all;
  }
  method = all;
  return study;
}

}  // namespace corral::testing
