// SPDX-License-Identifier: MIT
#pragma once

// Runs the program as a user does: a line typed in a folder of its own.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "io/disk/file.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/synthetic.h"
#include "tests/io/scratch.h"
#include "tests/support/meshes.h"

namespace corral::testing {

/// What a command said and how it ended.
struct Outcome {
  int status;
  std::string out, err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// It ended well and said nothing.
inline void expect_ok(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
}

/// A working folder; what the commands say is caught outside it.
class Workplace {
 public:
  /// `arguments` as typed after the word corral; the shell sees them.
  Outcome corral(const std::string& arguments) const {
    const std::string out = captured_ / "out", err = captured_ / "err";
    const std::string line = "( cd '" + folder_.path() + "' && '" CORRAL_PROGRAM "' " + arguments + " ) >'" + out +
                             "' 2>'" + err + "' </dev/null";
    const int ended = std::system(line.c_str());
    return {WIFEXITED(ended) ? WEXITSTATUS(ended) : -1, text_of(out), text_of(err)};
  }

  std::string operator/(const std::string& name) const { return folder_ / name; }
  std::vector<std::string> names() const { return folder_.names(); }
  void put(const std::string& name, const std::string& content) const { put_text(folder_ / name, content); }
  std::string text(const std::string& name) const { return text_of(folder_ / name); }

  /// matches.csv, truth.txt and group.csv of a problem with 60 right ones among 100 matches, all of them selected.
  SyntheticProblem put_problem() const {
    SyntheticOptions options;
    options.matches = 100;
    options.inlier_ratio = 0.6;
    SyntheticProblem problem = make_synthetic_problem(options);
    put("matches.csv", matches_text(problem.matches));
    put("truth.txt", transform_text(problem.truth));
    put("group.csv", group_text({100, problem.inliers, {}}));
    return problem;
  }

  /// model.ply, about 2562 vertices, and its moved and slightly noisy copy.ply with truth.txt.
  void put_pair() const {
    write_mesh(folder_ / "model.ply", bumpy_sphere(4, 1));
    const Outcome made = corral("perturb model.ply --noise-pr 0.05 --seed 3 -o copy.ply --truth truth.txt");
    if (made.status != 0) throw std::runtime_error("corral perturb: " + made.err);
  }

 private:
  ScratchFolder folder_, captured_;
};

inline std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// The names of the members of a JSON object, in order of the alphabet.
inline std::vector<std::string> keys_of(const nlohmann::json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

}  // namespace corral::testing
