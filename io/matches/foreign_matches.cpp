// SPDX-License-Identifier: MIT
#include "io/matches/foreign_matches.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/matches/label_file.h"
#include "io/matches/named_arrays.h"
#include "kernel/error.h"

namespace corral {
namespace {

using Name = const char*;

// The names of the six coordinates in a line of names; the first that are there count.
constexpr std::array<std::array<Name, 6>, 6> kColumns = {
    {{"source_x", "source_y", "source_z", "target_x", "target_y", "target_z"},
     {"src_x", "src_y", "src_z", "tgt_x", "tgt_y", "tgt_z"},
     {"src_x", "src_y", "src_z", "dst_x", "dst_y", "dst_z"},
     {"x1", "y1", "z1", "x2", "y2", "z2"},
     {"x0", "y0", "z0", "x1", "y1", "z1"},
     {"px", "py", "pz", "qx", "qy", "qz"}}};

std::string count_text(int count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

bool is_whole(const Eigen::Ref<const Eigen::MatrixXd>& numbers) {
  return numbers.unaryExpr([](double number) { return std::floor(number) == number; }).all();  // false for nan
}

/// Collects the rows of a file.
class Reader {
 public:
  explicit Reader(const ForeignFiles& files) : files_(files) {}

  ForeignMatches read() {
    if (!files_.targets.empty())
      add_two(read_number_table(files_.matches), read_number_table(files_.targets));
    else if (is_archive(files_.matches))
      read_arrays(files_.matches);
    else
      add_table(read_number_table(files_.matches), files_.source, files_.target);
    finish();
    return std::move(found_);
  }

 private:
  void read_arrays(const std::string& path) {
    NamedArrays arrays(path);
    const NamedArrays::Pair points = arrays.points();
    if (const std::string table = arrays.matches(); !table.empty()) {
      NumberTable rows = arrays.read(table);
      Points source, target;
      const bool has_points = rows.width() == 2 && !points.source.empty();
      if (has_points) {
        source = points_of(with_width(arrays.read(points.source), 3, "the points"));
        target = points_of(with_width(arrays.read(points.target), 3, "the points"));
      }
      add_table(std::move(rows), has_points ? &source : files_.source, has_points ? &target : files_.target);
    } else if (!points.source.empty()) {
      add_two(arrays.read(points.source), arrays.read(points.target));
    } else {
      throw IoError(path, "",
                    "has the arrays " + arrays.unread() +
                        ", no matches under a known name, expected FILE:NAME of "
                        "the matches, or of source and target points");
    }
    found_.target_from_source = arrays.pose();
    if (const std::string name = arrays.labels(); !name.empty())
      found_.labels = labels_of(arrays.read(name), found_.rows);
    if (const std::string unread = arrays.unread(); !unread.empty()) note("arrays that are not read: " + unread);
  }

  void add_table(NumberTable table, const Points* source, const Points* target) {
    if (!table.names.empty() && add_named(table)) return;
    const bool are_pairs = table.width() == 2 && is_whole(table.rows);  // also six of them
    if (are_pairs || (table.width() < 6 && table.size() != 6)) return add_indices(table, source, target);
    table = with_width(std::move(table), 6, "the matches");
    add_rows(table, {0, 1, 2, 3, 4, 5});
    int ignored = table.width() - 6;
    if (ignored > 0 && is_binary(table.rows.row(6))) {
      take_labels(table, 6);
      note("column 7 holds 0 and 1 only and is taken for labels");
      --ignored;
    }
    if (ignored > 0) note(count_text(ignored, "further column") + " not read");
  }

  /// By the names of the columns; false if they do not name the six.
  bool add_named(const NumberTable& table) {
    const auto place = [&](const std::string& name) {
      return static_cast<int>(std::find(table.names.begin(), table.names.end(), name) - table.names.begin());
    };
    for (const auto& names : kColumns) {
      std::array<int, 6> columns;
      std::transform(names.begin(), names.end(), columns.begin(), place);
      if (std::any_of(columns.begin(), columns.end(), [&](int column) { return column == table.width(); })) continue;
      add_rows(table, columns);
      for (const Name name : {"label", "labels", "gt_label", "gt_labels"})
        if (place(name) < table.width() && found_.labels.empty()) take_labels(table, place(name));
      if (const int column = place("feature_distance"); column < table.width())
        found_.matches.feature_distance = table.rows.row(column).transpose();
      return true;
    }
    return false;
  }

  void take_labels(const NumberTable& table, int column) {
    NumberTable labels;
    labels.path = table.path;
    labels.lines = table.lines;
    labels.rows = table.rows.row(column);
    found_.labels = labels_of(labels, found_.rows);
  }

  void add_indices(const NumberTable& table, const Points* source, const Points* target) {
    if (table.width() < 2 || !is_whole(table.rows.topRows(2)))
      table.fail(0, "found " + std::to_string(table.width()) +
                        " numbers, expected six coordinates or a pair of indices, or two files of points");
    if (!source || !target)
      throw IoError(
          table.path, "",
          "holds pairs of indices, expected the clouds that they count in, source and target" +
              std::string(table.width() == 3 ? "; or, if these are points, the file of the target points" : ""));
    const Eigen::Vector2d least = table.rows.topRows(2).rowwise().minCoeff(),
                          most = table.rows.topRows(2).rowwise().maxCoeff();
    const bool reaches_count = most(0) == double(source->rows()) || most(1) == double(target->rows());
    const int first = files_.first_index.value_or(least.minCoeff() >= 1 && reaches_count ? 1 : 0);
    if (!files_.first_index)
      note(first == 1 ? "the indices count from 1: none is 0, and one is the number of points"
                      : "the indices are taken to count from 0");
    for (int row = 0; row < table.size(); ++row) {
      found_.matches.source_keypoints.push_back(index_of(table, row, 0, first, source->rows()));
      found_.matches.target_keypoints.push_back(index_of(table, row, 1, first, target->rows()));
    }
    found_.matches.source_points = (*source)(found_.matches.source_keypoints, Eigen::all);
    found_.matches.target_points = (*target)(found_.matches.target_keypoints, Eigen::all);
    found_.rows = table.size();
    append_notes(table);
    if (table.width() > 2) note(count_text(table.width() - 2, "further column") + " not read");
  }

  static int index_of(const NumberTable& table, int row, int side, int first, Eigen::Index points) {
    const double index = table.rows(side, row) - first;
    if (!(index >= 0 && index < static_cast<double>(points)))
      table.fail(row, "the index of a " + std::string(side == 0 ? "source" : "target") + " point is " +
                          std::to_string(static_cast<long long>(table.rows(side, row))) + ", expected " +
                          std::to_string(first) + " .. " + std::to_string(points - 1 + first));
    return static_cast<int>(index);
  }

  void add_two(NumberTable source, NumberTable target) {
    source = with_width(std::move(source), 3, "the source points");
    target = with_width(std::move(target), 3, "the target points");
    if (source.size() != target.size())
      throw IoError(target.path, "",
                    "has " + count_text(target.size(), "point") + ", expected one for each of the " +
                        std::to_string(source.size()) + " of " + source.path);
    for (NumberTable* table : {&source, &target}) {
      check(*table, {0, 1, 2});
      append_notes(*table);
      if (table->width() > 3) note(table->path + ": " + count_text(table->width() - 3, "further column") + " not read");
    }
    found_.rows = source.size();
    found_.matches.source_points = points_of(source);
    found_.matches.target_points = points_of(target);
  }

  void add_rows(const NumberTable& table, const std::array<int, 6>& columns) {
    check(table, {columns.begin(), columns.end()});
    append_notes(table);
    found_.rows = table.size();
    found_.matches.source_points.resize(table.size(), 3);
    found_.matches.target_points.resize(table.size(), 3);
    for (int axis = 0; axis < 3; ++axis) {
      found_.matches.source_points.col(axis) = table.rows.row(columns[std::size_t(axis)]).transpose();
      found_.matches.target_points.col(axis) = table.rows.row(columns[std::size_t(axis + 3)]).transpose();
    }
  }

  static Points points_of(const NumberTable& table) { return table.rows.topRows(3).transpose(); }

  /// A nan is a missing point; an infinite number is none.
  static void check(const NumberTable& table, const std::vector<int>& columns) {
    for (int row = 0; row < table.size(); ++row)
      for (const int column : columns)
        if (std::isinf(table.rows(column, row))) table.fail(row, "a coordinate is infinite, expected a finite number");
  }

  /// Leaves out the rows with a nan.
  void finish() {
    const CorrespondenceSet& all = found_.matches;
    const Eigen::VectorXd sums = all.source_points.rowwise().sum() + all.target_points.rowwise().sum();
    for (int row = 0; row < found_.rows; ++row)
      if (!std::isnan(sums(row)) && !(all.feature_distance.size() > 0 && std::isnan(all.feature_distance(row))))
        found_.kept.push_back(row);
    const int left_out = found_.rows - static_cast<int>(found_.kept.size());
    if (found_.kept.empty()) throw IoError(files_.matches, "", "has no row without a nan, expected matches");
    if (left_out > 0) {
      note(count_text(left_out, "row") + " with a nan left out");
      found_.matches = select_rows(all, found_.kept);
    }
    found_.matches.validate();
  }

  void append_notes(const NumberTable& table) {
    found_.notes.insert(found_.notes.end(), table.notes.begin(), table.notes.end());
  }
  void note(const std::string& text) { found_.notes.push_back(text); }

  const ForeignFiles& files_;
  ForeignMatches found_;
};

}  // namespace

ForeignMatches read_foreign_matches(const ForeignFiles& files) { return Reader(files).read(); }

}  // namespace corral
