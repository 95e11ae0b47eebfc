// SPDX-License-Identifier: MIT
#include "apps/study/find_dataset.h"

#include <algorithm>
#include <filesystem>

#include "io/text/line_reader.h"
#include "kernel/error.h"

namespace corral {
namespace {

namespace fs = std::filesystem;

bool is_dataset(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "dataset.toml", ignored);
}

}  // namespace

Dataset find_dataset(const std::string& data_folder, const std::string& name, const std::string& experiment) {
  if (is_dataset(data_folder)) return read_dataset(data_folder);
  const fs::path folder = fs::path(data_folder) / name;
  if (is_dataset(folder)) {
    Dataset dataset = read_dataset(folder.string());
    if (dataset.name == name) return dataset;
    throw IoError(dataset.path("dataset.toml"), "name",
                  "is " + corral::quoted(dataset.name) + ", expected that of its folder");
  }
  std::error_code ignored;
  if (!fs::is_directory(data_folder, ignored))
    throw IoError(data_folder, "", "is not a folder, expected a data set or a folder of data sets");
  std::vector<std::string> present;
  for (const auto& entry : fs::directory_iterator(data_folder, ignored))
    if (is_dataset(entry.path())) present.push_back(entry.path().filename().string());
  std::sort(present.begin(), present.end());
  std::string list;
  for (const std::string& each : present) list += (list.empty() ? "" : ", ") + each;
  throw IoError(data_folder, "",
                "has no data set " + corral::quoted(name) + ", which the experiment " + experiment + " uses; " +
                    (list.empty() ? "expected a folder with dataset.toml in it" : "it has " + list));
}

}  // namespace corral
