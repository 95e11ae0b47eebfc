// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/report/page_sample.h"
#include "apps/results/study_results.h"

namespace corral {

/// The figures and tables of a page, as JSON with numbers rounded to five digits:
///   runs         {folder, facts}: the manifest without its experiments and pairs
///   experiments  {run, name, title, figure, dataset, attribute, axis, levels, methods, bounds, threshold_pr,
///                least_true_matches, failed, means}, failed: how many records; means: the rows of the summary, or of the times
///   measures     {name, title, axis, unit, decimals, panel, record}: those of a panel, or of a column of the records
///   choices      which grouper to use (MethodChoice), one for each data set; cells without pairs are left out
///   found        what was found beside the paper's findings (FoundStatement)
///   totals       {records, pairs, exclusions, failed}: of the studies, whatever the page carries of them
///   records      columns: {name: [a cell per record]}; names that repeat are numbers of `words`; `excluded` is 0 or 1
/// `carried`: the records of the page. Throws IoError for a file that is missing or wrong.
nlohmann::ordered_json page_tables(const std::vector<StudyResults>& studies, const PageRecords& carried);

}  // namespace corral
