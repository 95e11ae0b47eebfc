// SPDX-License-Identifier: MIT
// The plan of the house, kept by itself: who may include whom, which library lives where, what every file owes.

// Under the sanitisers g++ 12 sees uninitialised values inside std::regex that are not there.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kRoot = CORRAL_SOURCE_DIR;

struct Room {
  Names includes;   ///< rooms whose headers it may include
  Names libraries;  ///< owners of <...> headers that it may include, beside the standard library
};

const Names kSurfaceLibraries = {"Eigen", "hwy", "CGAL", "OpenMesh", "flann", "boost"};
const Names kAppLibraries = {"Eigen", "CLI", "nlohmann", "oneapi", "boost"};

/// The rooms of apps/ from the lowest to the highest: none includes one above it.
const std::vector<std::string> kAppFloors = {
    "apps/runtime", "apps/picture", "apps/pair",      "apps/align",  "apps/dataset",    "apps/results", "apps/advise",
    "apps/study",   "apps/claims",  "apps/reproduce", "apps/report", "apps/scoreboard", "apps/commands"};

/// Rooms by folder, or by file; the longest that fits a file is its room.
std::map<std::string, Room> make_rooms() {
  const std::string surface = "kernel/surface", mesh = surface + "/mesh", search = surface + "/search",
                    matching = surface + "/matching", scan = surface + "/scan";
  const std::string result = "grouping/grouper.h", columns = "grouping/columns", graph = "grouping/graph",
                    pose = "grouping/pose";
  const std::string disk = "io/disk", text = "io/text", array = "io/array", meshes = "io/mesh", poses = "io/pose",
                    pairs = "io/pairs", matches = "io/matches";
  const Names all_of_surface = {surface, mesh, search, matching, scan};
  std::map<std::string, Room> rooms = {
      {"kernel", {{"kernel"}, {"Eigen", "hwy"}}},
      {mesh, {{"kernel", mesh}, kSurfaceLibraries}},
      {search, {{"kernel", mesh, search}, kSurfaceLibraries}},
      {matching, {{"kernel", matching}, kSurfaceLibraries}},
      {scan, {{"kernel", mesh, search, scan}, kSurfaceLibraries}},
      {result, {{"kernel"}, {}}},
      {columns, {{"kernel", result, columns}, {"Eigen", "hwy"}}},
      {graph, {{"kernel", result, columns, graph}, {"Eigen", "hwy"}}},
      {pose, {{"kernel", result, columns, pose}, {"Eigen", "hwy"}}},
      {"grouping", {{"kernel", result, columns, graph, pose, "grouping"}, {"Eigen", "hwy"}}},
      {"refine", {{"kernel", "refine"}, {"Eigen", "hwy", "ceres"}}},
  };
  Room pipeline{all_of_surface, kSurfaceLibraries}, of_meshes{all_of_surface, {"Eigen"}};
  pipeline.includes.insert("kernel");
  of_meshes.includes.insert({"kernel", disk, text, meshes});
  rooms[surface] = pipeline;
  rooms[disk] = {{"kernel", disk}, {}};
  rooms[text] = {{"kernel", disk, text}, {"Eigen", "toml++"}};
  rooms[array] = {{"kernel", disk, text, array}, {"Eigen"}};
  rooms[poses] = {{"kernel", disk, text, array, poses}, {"Eigen", "nlohmann"}};
  rooms[meshes] = of_meshes;
  rooms[pairs] = {{"kernel", disk, text, poses, pairs}, {"Eigen"}};
  rooms[matches] = {{"kernel", disk, text, array, poses, matches}, {"Eigen"}};
  Names below = {"kernel", "grouping", result, columns, graph,  pose,  "refine",
                 disk,     text,       array,  poses,   meshes, pairs, matches};
  below.insert(all_of_surface.begin(), all_of_surface.end());
  for (const std::string& floor : kAppFloors) {
    below.insert(floor);
    below.insert(floor + "/figure");
    rooms[floor] = {below, kAppLibraries};
  }
  for (const char* subject : {"pair", "surface", "data", "study"}) {  // beside each other, over what they share
    const std::string room = std::string("apps/commands/") + subject;
    rooms[room] = rooms["apps/commands"];
    rooms[room].includes.insert(room);
  }
  Names under_figures = rooms["apps/report"].includes;
  under_figures.erase("apps/report");  // figures know no report
  rooms["apps/report/figure"] = {under_figures, kAppLibraries};
  rooms["apps/report/figure"].libraries.insert("fontconfig");  // measures text
  rooms["apps"] = {below, kAppLibraries};                      // the program itself
  rooms["apps/plugin-template"] = {{"grouping"}, {}};
  Names for_python = {"apps/python/module", "apps/pair", "apps/runtime"};  // as its CMakeLists.txt builds it
  for (const auto& [room, rules] : rooms)
    if (room.rfind("apps", 0) != 0) for_python.insert(room);
  rooms["apps/python/module"] = {for_python, {"Eigen", "pybind11"}};
  return rooms;
}
const std::map<std::string, Room> kRooms = make_rooms();

const Names kNeverInHeaders = {"hwy", "CGAL", "OpenMesh", "flann", "ceres", "toml++", "boost", "zlib.h", "lzf.h"};
const Names kOnlyInApps = {"chrono", "thread", "iostream", "ctime", "future"};  // clocks, threads, printing

struct Include {
  std::string file;
  bool quoted;
  std::string name;
};

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string room_of(const std::string& file) {
  std::string best;
  for (const auto& [room, rules] : kRooms)
    if ((file == room || file.rfind(room + "/", 0) == 0) && room.size() > best.size()) best = room;
  return best;
}

/// Every C++ file below the rooms and tests/, relative to the root.
std::vector<std::string> source_files() {
  std::vector<std::string> files;
  for (const char* top : {"kernel", "grouping", "refine", "io", "apps", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(fs::relative(entry.path(), kRoot).generic_string());
  return files;
}

std::vector<Include> includes() {
  static const std::regex pattern("^\\s*#\\s*include\\s*([<\"])([^>\"]+)[>\"]");
  std::vector<Include> found;
  for (const std::string& file : source_files()) {
    std::istringstream lines(read(kRoot / file));
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_search(line, match, pattern)) found.push_back({file, match[1] == "\"", match[2]});
  }
  return found;
}

bool is_header(const std::string& file) { return fs::path(file).extension() == ".h"; }

/// Compiled once for each target of Highway, and only in sources.
bool is_for_targets(const std::string& file) { return std::regex_search(file, std::regex("-inl\\.h$")); }

TEST(Layering, RoomsIncludeOnlyWhatThePlanAllows) {
  int checked = 0;
  for (const Include& include : includes()) {
    const std::string room = room_of(include.file);
    if (!include.quoted || room.empty()) continue;
    ++checked;
    const std::string other = room_of(include.name);
    EXPECT_TRUE(kRooms.at(room).includes.count(other)) << include.file << " includes " << include.name;
  }
  EXPECT_GT(checked, 50);
}

TEST(Layering, LibrariesStayInTheirRooms) {
  int checked = 0;
  for (const Include& include : includes()) {
    const std::string room = room_of(include.file);
    const std::string owner = include.name.substr(0, include.name.find('/'));
    const bool is_library = include.name.find('/') != std::string::npos && owner != "sys";
    if (include.quoted || room.empty()) continue;
    ++checked;
    if (is_library) {
      EXPECT_TRUE(kRooms.at(room).libraries.count(owner)) << include.file << " includes " << include.name;
    }
    if (room.rfind("apps", 0) != 0) {
      EXPECT_FALSE(kOnlyInApps.count(include.name)) << include.file << " includes " << include.name;
    }
    if (is_header(include.file) && !is_for_targets(include.file)) {
      EXPECT_FALSE(kNeverInHeaders.count(owner)) << include.file << " includes " << include.name;
    }
  }
  EXPECT_GT(checked, 100);
}

/// The rooms of the plan, so that a new folder is given a place in it.
TEST(Layering, EveryFolderIsARoom) {
  for (const std::string& file : source_files()) {
    const std::string folder = fs::path(file).parent_path().generic_string();
    if (folder.rfind("tests", 0) == 0) continue;
    EXPECT_TRUE(kRooms.count(folder)) << folder << " is in no plan";
  }
}

TEST(Layering, NoTypeIsDefinedInTwoHeaders) {
  static const std::regex definition("^(?:struct|class|enum class) ([A-Z][A-Za-z0-9]*)[^;]*\\{");
  std::map<std::string, std::string> first;
  for (const std::string& file : source_files()) {
    if (!is_header(file) || room_of(file).empty()) continue;
    std::istringstream lines(read(kRoot / file));
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_search(line, match, definition)) {
        const auto [place, is_new] = first.emplace(match[1], file);
        EXPECT_TRUE(is_new || place->second == file)
            << match[1] << " stands in " << place->second << " and in " << file;
      }
  }
  EXPECT_GT(first.size(), 100u);
}

TEST(Layering, TestsLieWhereTheirFilesLie) {
  for (const std::string& file : source_files()) {
    const fs::path path(file);
    const std::string stem = path.stem().string();
    if (path.begin()->string() != "tests" || stem.size() < 6 || stem.substr(stem.size() - 5) != "_test") continue;
    const std::string room = path.parent_path().lexically_relative("tests").generic_string();
    if (Names{".", "io", "grouping/memory", "apps/report/page", "apps/scoreboard/site", "fuzz"}.count(room))
      continue;  // tests of the whole
    EXPECT_TRUE(kRooms.count(room)) << file << " mirrors no room";
  }
}

TEST(Layering, EveryFileIsLicensedAndOfAReadableLength) {
  for (const std::string& file : source_files()) {
    const std::string text = read(kRoot / file);
    EXPECT_EQ(text.rfind("// SPDX-License-Identifier: MIT\n", 0), 0u) << file;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 400) << file;
    if (is_header(file)) {
      EXPECT_NE(text.find(is_for_targets(file) ? "HWY_TARGET_TOGGLE" : "#pragma once"), std::string::npos) << file;
    }
  }
}

TEST(Layering, HeadersForTargetsStayInSources) {
  int checked = 0;
  for (const Include& include : includes()) {
    if (!include.quoted || !is_for_targets(include.name)) continue;
    ++checked;
    EXPECT_TRUE(!is_header(include.file) || is_for_targets(include.file))
        << include.file << " includes " << include.name;
  }
  EXPECT_GT(checked, 10);
}

/// Vector code stands on Highway: what it is made of would build with one compiler, or for one machine, only.
TEST(Layering, NoAssemblyAttributesOrBuiltins) {
  static const std::regex own("\\basm\\s*(volatile\\s*)?\\(|__attribute__|\\[\\[gnu::|__builtin_|immintrin|arm_neon");
  for (const std::string& file : source_files()) {
    std::smatch match;
    const std::string text = read(kRoot / file);
    if (file == "tests/layering_test.cpp") continue;
    EXPECT_FALSE(std::regex_search(text, match, own)) << file << ": " << match.str();
  }
}

TEST(Layering, TheTopLevelIsTheAgreedOne) {
  const Names agreed = {"CMakeLists.txt",
                        "CMakePresets.json",
                        "LICENSE",
                        "CITATION.cff",
                        "README.md",
                        "kernel",
                        "grouping",
                        "refine",
                        "io",
                        "apps",
                        "tests",
                        "data",
                        "paper",
                        "build"};
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename().string();
    if (name.front() != '.') {
      EXPECT_TRUE(agreed.count(name)) << name;
    }
  }
}

TEST(Layering, EveryCitationIsInTheBibliography) {
  const std::string bibliography = read(kRoot / "paper/references.bib");
  static const std::regex citation("\\[([a-z]+[0-9]{4}[a-z]+)\\]");
  std::vector<std::string> files = source_files();
  for (const char* room :
       {"", "kernel/", "kernel/surface/", "grouping/", "refine/", "io/", "apps/", "tests/", "data/", "paper/"})
    files.push_back(room + std::string("README.md"));
  int found = 0;
  for (const std::string& file : files) {
    const std::string text = read(kRoot / file);
    for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it, ++found)
      EXPECT_NE(bibliography.find("{" + (*it)[1].str() + ","), std::string::npos) << file << ": " << (*it)[1];
  }
  EXPECT_GT(found, 20);
}

TEST(Layering, TheReadmeOfGroupingListsTheGroupersAsTheProgramDoes) {
  std::FILE* pipe = popen(CORRAL_PROGRAM " groupers --markdown", "r");
  ASSERT_NE(pipe, nullptr);
  std::string table;
  char buffer[4096];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) table.append(buffer, count);
  ASSERT_EQ(pclose(pipe), 0);
  EXPECT_THAT(table, ::testing::StartsWith("| grouper |"));
  EXPECT_NE(read(kRoot / "grouping/README.md").find(table), std::string::npos)
      << "the table of grouping/README.md should be:\n"
      << table;
}

}  // namespace
