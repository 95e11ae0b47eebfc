// SPDX-License-Identifier: MIT
#include "apps/dataset/set_folder.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/error.h"
#include "kernel/random.h"

namespace corral {

namespace fs = std::filesystem;

SetFolder::SetFolder(const std::string& folder, const std::string& recipe) : folder_(folder) {
  make_folder(folder);
  const std::string note = path(kRecipeName);
  for (const char* name : {"dataset.toml", "pairs.csv"})
    if (!fs::exists(note) && fs::exists(path(name)))
      throw IoError(folder, "",
                    std::string("holds a ") + name + " that this command did not make, expected an empty folder");
  if (fs::exists(note) && read_file(note) != recipe)
    throw IoError(folder, "",
                  "holds a data set made from other input or options (see " + std::string(kRecipeName) +
                      "), expected an empty folder or the same ones");
  check_writable(path("dataset.toml"));
  if (fs::exists(note))
    remove_leftovers(folder);
  else
    write_file(note, recipe);
}

std::string SetFolder::path(const std::string& file) const { return (fs::path(folder_) / file).string(); }

bool SetFolder::has(const std::string& file) const { return fs::exists(path(file)); }

void SetFolder::put(const std::string& file, const std::string& content) const {
  make_folder(fs::path(path(file)).parent_path().string());
  write_file(path(file), content);
}

void SetFolder::finish(const Dataset& dataset) const {
  write_files({{path("pairs.csv"), pairs_csv_text(dataset)}, {path("dataset.toml"), dataset_toml_text(dataset)}});
}

std::vector<std::string> mesh_files(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_mesh_name(entry->path().string()) && entry->is_regular_file(error)) files.push_back(entry->path().string());
  if (error) throw IoError(folder, "", "cannot be read as a folder (" + error.message() + ")");
  if (files.empty()) throw IoError(folder, "", "has no meshes, expected files such as model.ply or model.obj");
  std::sort(files.begin(), files.end());
  return files;
}

std::string checksum(const std::string& path) { return std::to_string(derive_seed(0, read_file(path))); }

std::string file_word(const std::string& file) { return pair_word(fs::path(file).stem().string()); }

std::string pair_word(std::string text) {
  const auto fits = [](unsigned char letter) {
    return letter < 128 && (std::isalnum(letter) || letter == '.' || letter == '_' || letter == '+' || letter == '-');
  };
  std::replace_if(
      text.begin(), text.end(), [&](unsigned char letter) { return !fits(letter); }, '-');
  if (!text.empty() && text[0] == '.') text[0] = '-';
  return text;
}

}  // namespace corral
