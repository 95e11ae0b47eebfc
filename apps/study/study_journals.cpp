// SPDX-License-Identifier: MIT
#include "apps/study/study_journals.h"

#include <algorithm>
#include <map>

#include "apps/runtime/build_info.h"
#include "apps/study/finished_units.h"
#include "apps/study/manifest.h"
#include "apps/study/plan.h"
#include "kernel/error.h"

namespace corral {

StudyJournals find_study(const std::string& folder) {
  std::map<std::string, std::vector<JournalFile>> by_identity;
  std::map<std::string, JournalHeader> headers;
  for (const JournalFile& journal : find_journals(folder)) {
    const std::optional<JournalHeader> header = JournalReader(journal.path).header();
    if (!header) continue;
    const StudyIdentity& identity = header->identity;
    const std::string key = identity.experiments + " " + identity.version + " " + identity.commit;
    headers.try_emplace(key, *header);
    by_identity[key].push_back(journal);
  }
  if (by_identity.empty())
    throw IoError(folder, "", "has no journals of finished pairs, expected a folder of 'corral evaluate --shard'");
  const BuildInfo build = build_info();
  const auto weight = [&](const auto& journals) {  // of equally many, those that this program made
    const StudyIdentity& identity = headers.at(journals.first).identity;
    return std::pair(journals.second.size(), identity.version == build.version && identity.commit == build.commit);
  };
  const auto most = std::max_element(by_identity.begin(), by_identity.end(),
                                     [&](const auto& a, const auto& b) { return weight(a) < weight(b); });
  const JournalHeader& header = headers.at(most->first);
  for (const auto& [key, journals] : by_identity)
    if (key != most->first)
      throw IoError(journals.front().path, "",
                    "was made " + headers.at(key).identity.difference_from(header.identity) + ", unlike " +
                        most->second.front().path + ", expected the shards of one study (remove what does not belong)");
  return {header.identity, header.call, header.command_line, most->second};
}

WorkList work_list_of(const StudyJournals& study, const std::string& data) {
  StudyCall call = study.call;
  if (!data.empty()) call.data = data;
  WorkList list = work_list_of(call);
  const std::string difference = study.identity.difference_from(identity_of(list));
  if (!difference.empty())
    throw IoError(study.files.front().path, "",
                  "was made " + difference + ", expected the same program, and the data sets as they were");
  return list;
}

RecordedTimes recorded_times(const std::string& folder) {
  const StudyJournals study = find_study(folder);
  const WorkList list = work_list_of(study);
  FinishedUnits finished(list, folder, {});
  for (const JournalFile& journal : study.files) {
    JournalReader reader(journal.path);
    finished.add(reader, journal);
  }
  const std::vector<UnitEstimate> estimates = estimate_units(list);
  RecordedTimes times;
  double recorded = 0, estimated = 0;
  for (std::size_t unit = 0; unit < estimates.size(); ++unit) {
    if (!finished.has(unit)) continue;
    recorded += times.seconds[unit_key(list.units[unit])] = finished.seconds()[unit];
    estimated += estimates[unit].seconds();
  }
  if (!(recorded > 0)) throw IoError(folder, "", "has no finished pairs, expected some whose times are recorded");
  times.factor = recorded / estimated;
  return times;
}

}  // namespace corral
