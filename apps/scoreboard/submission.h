// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/pair/external_method.h"
#include "io/disk/file.h"
#include "io/pairs/dataset_file.h"

namespace corral {

/// The answers of one method to the tables of a data set: a folder with method.toml, tables.csv, labels/<pair>.csv,
/// poses/<pair>.txt (if it states poses) and times.csv.
struct Submission {
  std::string folder;
  std::string name, title;          ///< letters, digits and . _ + - ; for people
  std::string url, licence, needs;  ///< of the method; in words; may be empty
  std::string dataset;              ///< name of the set
  bool is_deterministic = false;    ///< as its authors say
  bool has_poses = false;           ///< of every table that it answers; else it states none

  /// methods.toml of `corral evaluate --methods` with this method alone.
  std::string methods_text() const;
};

/// Reads method.toml. Throws IoError naming file, line and key.
Submission read_submission(const std::string& folder);

/// How a method is asked for its rows, and perhaps a pose.
struct SubmittedMethod {
  Submission facts;
  GroupFunction group;
};

/// The files of a submission: the method's answers to every table of the set. Truths are not read. A table that it refuses
/// has no answer, which counts as a failure.
/// Throws    IoError: a pair without a table of matches.
std::vector<FileContent> pack_submission(const SubmittedMethod& method, const Dataset& dataset,
                                         const std::string& folder,
                                         const std::function<void(const std::string& pair)>& observer = {});

/// What is wrong with a submission, a sentence each: tables that are missing, more or not those of the data set (by their hashes),
/// answers that are not of their table. Empty if nothing is. Truths are not read.
std::vector<std::string> check_submission(const Submission& submission, const Dataset& dataset);

}  // namespace corral
