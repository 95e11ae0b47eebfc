// SPDX-License-Identifier: MIT
#include "io/matches/matches_file.h"

#include <algorithm>
#include <map>

#include "io/disk/file.h"
#include "io/text/line_reader.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

constexpr const char* kFirstLine = "# corral matches 1";
constexpr std::int64_t kLargestIndex = 2147483647;

std::vector<std::string> numbered(const std::string& prefix, int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(prefix + std::to_string(i));
  return names;
}

/// The lines before the header.
void read_preamble(LineReader& reader, CorrespondenceSet& matches) {
  reader.need(kFirstLine);
  if (reader.line() != kFirstLine) reader.fail("found " + quoted(reader.line()) + ", expected " + quoted(kFirstLine));
  bool has_resolution = false;
  const auto once = [&](bool seen) {
    if (seen) reader.fail("found " + quoted(reader.line()) + " a second time, expected it once");
  };
  for (reader.need("'# resolution R'"); reader.line().front() == '#'; reader.need("the header of the columns")) {
    std::vector<std::string_view> fields = reader.fields();
    if (fields[0].size() > 1) fields.insert(fields.begin() + 1, fields[0].substr(1));  // "#resolution 1"
    if (fields.size() == 3 && fields[1] == "resolution") {
      once(has_resolution);
      matches.resolution = reader.finite_number(fields[2]);
      if (!(matches.resolution > 0))
        reader.fail("the resolution is " + quoted(fields[2]) + ", expected a length above zero");
      has_resolution = true;
    } else if (fields.size() >= 2 && fields[1] == "source_centroid") {
      once(matches.source_centroid.has_value());
      if (fields.size() != 5) reader.fail("found " + quoted(reader.line()) + ", expected '# source_centroid x y z'");
      matches.source_centroid = Eigen::Vector3d(reader.finite_number(fields[2]), reader.finite_number(fields[3]),
                                                reader.finite_number(fields[4]));
    } else if (fields.size() >= 2 && fields[1] == "resolution") {
      reader.fail("found " + quoted(reader.line()) + ", expected '# resolution R'");
    }
  }
  if (!has_resolution) reader.fail("no '# resolution R' before the header, expected one");
}

/// Which field of a row holds a column.
class Columns {
 public:
  explicit Columns(LineReader& reader) : reader_(reader) {
    const auto& names = reader.fields(',');
    count_ = names.size();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!places_.emplace(names[i], i).second) reader.fail("column " + quoted(names[i]) + " occurs twice");
  }

  std::size_t count() const { return count_; }
  /// The places of all the names, or none of them; some but not all is an error, as is none if they are required.
  std::vector<std::size_t> find(const std::vector<std::string>& names, bool required) const {
    std::vector<std::size_t> places;
    std::string missing;
    for (const std::string& name : names) {
      const auto found = places_.find(name);
      if (found != places_.end())
        places.push_back(found->second);
      else if (missing.empty())
        missing = name;
    }
    if (!missing.empty() && (required || !places.empty()))
      reader_.fail("no column " + quoted(missing) + ", expected one");
    return places;
  }

 private:
  const LineReader& reader_;
  std::map<std::string, std::size_t, std::less<>> places_;
  std::size_t count_ = 0;
};

/// Appends the numbers of one row that stand at `places`.
void append_numbers(const LineReader& reader, const std::vector<std::string_view>& row,
                    const std::vector<std::size_t>& places, std::vector<double>& numbers) {
  for (const std::size_t place : places) numbers.push_back(reader.finite_number(row[place]));
}

void append_index(const LineReader& reader, const std::vector<std::string_view>& row,
                  const std::vector<std::size_t>& places, Indices& indices) {
  for (const std::size_t place : places)
    indices.push_back(static_cast<int>(reader.integer(row[place], 0, kLargestIndex, "a keypoint")));
}

Points to_points(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

Eigen::VectorXd to_vector(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

LocalReferenceFrames to_frames(const std::vector<double>& numbers) {
  LocalReferenceFrames frames;
  for (std::size_t i = 0; i + 9 <= numbers.size(); i += 9)
    frames.emplace_back(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data() + i));
  return frames;
}

void append_frame(std::string& text, const LocalReferenceFrame& frame) {
  for (int i = 0; i < 9; ++i) text += "," + to_text(frame(i / 3, i % 3));
}

}  // namespace

CorrespondenceSet read_matches(const std::string& path) {
  const std::string content = read_file(path);
  if (content.empty()) throw IoError(path, "", "the file is empty, expected a table of matches");
  LineReader reader(path, content);
  CorrespondenceSet matches;
  read_preamble(reader, matches);
  const Columns columns(reader);
  const auto source = columns.find({"source_x", "source_y", "source_z"}, true);
  const auto target = columns.find({"target_x", "target_y", "target_z"}, true);
  const auto first = columns.find({"feature_distance"}, false),
             second = columns.find({"second_feature_distance"}, false);
  const auto source_frame = columns.find(numbered("source_frame_", 9), false);
  const auto target_frame = columns.find(numbered("target_frame_", 9), false);
  const auto source_keypoint = columns.find({"source_keypoint"}, false);
  const auto target_keypoint = columns.find({"target_keypoint"}, false);

  std::vector<double> sources, targets, firsts, seconds, source_frames, target_frames;
  while (reader.next()) {
    const auto& row = reader.fields(',');
    if (row.size() != columns.count())
      reader.fail("found " + std::to_string(row.size()) + " fields, expected " + std::to_string(columns.count()));
    append_numbers(reader, row, source, sources);
    append_numbers(reader, row, target, targets);
    append_numbers(reader, row, first, firsts);
    append_numbers(reader, row, second, seconds);
    append_numbers(reader, row, source_frame, source_frames);
    append_numbers(reader, row, target_frame, target_frames);
    append_index(reader, row, source_keypoint, matches.source_keypoints);
    append_index(reader, row, target_keypoint, matches.target_keypoints);
  }
  matches.source_points = to_points(sources);
  matches.target_points = to_points(targets);
  matches.feature_distance = to_vector(firsts);
  matches.second_feature_distance = to_vector(seconds);
  matches.source_frames = to_frames(source_frames);
  matches.target_frames = to_frames(target_frames);
  matches.validate();
  return matches;
}

std::string matches_text(const CorrespondenceSet& matches) {
  const bool has_first = matches.feature_distance.size() > 0, has_second = matches.second_feature_distance.size() > 0;
  std::string text = std::string(kFirstLine) + "\n# resolution " + to_text(matches.resolution) + "\n";
  if (const auto& centroid = matches.source_centroid)
    text += "# source_centroid " + to_text(centroid->x()) + " " + to_text(centroid->y()) + " " +
            to_text(centroid->z()) + "\n";
  if (!matches.source_keypoints.empty()) text += "source_keypoint,";
  if (!matches.target_keypoints.empty()) text += "target_keypoint,";
  text += "source_x,source_y,source_z,target_x,target_y,target_z";
  if (has_first) text += ",feature_distance";
  if (has_second) text += ",second_feature_distance";
  if (!matches.source_frames.empty())
    for (const std::string& name : numbered("source_frame_", 9)) text += "," + name;
  if (!matches.target_frames.empty())
    for (const std::string& name : numbered("target_frame_", 9)) text += "," + name;
  text += "\n";
  for (int row = 0; row < matches.size(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (!matches.source_keypoints.empty()) text += std::to_string(matches.source_keypoints[i]) + ",";
    if (!matches.target_keypoints.empty()) text += std::to_string(matches.target_keypoints[i]) + ",";
    text += to_text(matches.source_points(row, 0)) + "," + to_text(matches.source_points(row, 1)) + "," +
            to_text(matches.source_points(row, 2)) + "," + to_text(matches.target_points(row, 0)) + "," +
            to_text(matches.target_points(row, 1)) + "," + to_text(matches.target_points(row, 2));
    if (has_first) text += "," + to_text(matches.feature_distance(row));
    if (has_second) text += "," + to_text(matches.second_feature_distance(row));
    if (!matches.source_frames.empty()) append_frame(text, matches.source_frames[i]);
    if (!matches.target_frames.empty()) append_frame(text, matches.target_frames[i]);
    text += "\n";
  }
  return text;
}

}  // namespace corral
