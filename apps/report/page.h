// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/claims/claims.h"
#include "apps/results/study_results.h"

namespace corral {

struct PageOptions {
  std::string title = "Correspondence grouping: what the runs show";
  int pairs_in_3d = 60;  ///< at most so many pairs come with surfaces and matches, as far as they fit into `most_bytes`
  std::size_t most_records = 40'000;    ///< of larger studies the page carries a sample (sample_records), and says so
  std::size_t most_bytes = 19'500'000;  ///< of the page; figures, tables and records always come
  std::optional<std::vector<ClaimVerdict>> verdicts = {};
  std::string scripts = "/usr/share/javascript";  ///< where Debian's libjs-three and libjs-chart.js are
};

/// One HTML file that opens from disk without a network: panels of every experiment, pairs in a table, chosen pairs
/// in 3D with their matches, findings, and the facts of the runs. Means are those of the summary (of a run of times: its
/// times); no average is taken here. Absent values are gaps. Pairs in 3D: of every level the one of median mean F1, then the
/// worst, then the best, then the others, until there are enough; one that cannot be drawn is named with the reason. Same
/// runs, same bytes. `studies`: of the runs.
/// Throws    IoError: a file of a run, or a script of the two packages, that is missing or wrong.
std::string report_page(const std::vector<StudyFolder>& runs, const std::vector<StudyResults>& studies,
                        const PageOptions& options = {});

}  // namespace corral
