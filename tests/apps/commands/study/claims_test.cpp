// SPDX-License-Identifier: MIT
// corral claims, as a user types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.h"
#include "tests/support/simulated_run.h"

namespace corral {
namespace {

using testing::Outcome;
using testing::Workplace;

/// Times by which 3DHV takes `hough` of the time of GC.
void add_times(StudyFolder& run, double hough) {
  testing::add_times(run, {1500, 3000},
                     [&](const std::string& method, double) { return method == "hough" ? hough : 1.0; });
}

std::string verdict_of(const Workplace& place, const std::string& claim, const std::string& options) {
  const Outcome outcome = place.corral("claims run --json " + options);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json judged = outcome.json();
  for (const auto& found : judged["claims"])
    if (found["id"] == claim) return found["verdict"];
  return "";
}

TEST(Claims, OfAPrefixAreThoseOfTheMethodsWithIt) {
  const Workplace place;
  StudyFolder run, plain;
  add_times(run, 0.05);
  add_times(plain, 0.5);
  for (StudyRecord record : plain.records) {
    record.method = "plain-" + record.method;
    run.records.push_back(record);
  }
  for (const std::string& method : plain.experiments[0].methods)
    run.experiments[0].methods.push_back("plain-" + method);
  run.folder = place / "run";
  testing::write_run(run);
  EXPECT_EQ(verdict_of(place, "C55", ""), "holds");
  EXPECT_EQ(verdict_of(place, "C55", "--prefix plain-"), "fails");
  const Outcome unknown = place.corral("claims run --prefix other-");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, ::testing::HasSubstr("prefix"));
}

}  // namespace
}  // namespace corral
