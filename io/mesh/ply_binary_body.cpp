// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/mesh/mesh_cleanup.h"
#include "io/mesh/ply_body.h"
#include "kernel/error.h"
#include "kernel/number_text.h"

namespace corral {
namespace {

class BinaryBody : public PlyBody {
 public:
  BinaryBody(const std::string& path, std::string_view bytes, bool big_endian)
      : path_(path), bytes_(bytes), big_endian_(big_endian) {}

  std::size_t bytes_left() const override { return bytes_.size() - at_; }
  std::size_t smallest(const PlyElement& element) const override {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += (property.count_type ? property.count_type : property.type)->bytes;
    return bytes;
  }

  void read(const PlyElement& element, const PlyWanted& wanted) override {
    const auto has_lists = [](const PlyProperty& property) { return property.count_type != nullptr; };
    if (std::any_of(element.properties.begin(), element.properties.end(), has_lists))
      read_one_by_one(element, wanted);
    else
      read_columns(element, wanted);
  }

  void note_end(std::vector<std::string>& notes) override {
    if (bytes_left() > 0) notes.push_back(unread_note(bytes_left(), "element"));
  }
  [[noreturn]] void fail(const std::string& problem) const override {
    throw IoError(path_, "byte " + std::to_string(place_) + " after the header", problem);
  }

 private:
  /// Elements of one size: each number is at a fixed distance from the one before.
  void read_columns(const PlyElement& element, const PlyWanted& wanted) {
    const std::size_t stride = smallest(element), count = static_cast<std::size_t>(element.count);
    if (stride > 0 && count > bytes_left() / stride) {
      place_ = bytes_.size();
      fail("the file ends within element " + quoted(element.name) + " " + std::to_string(bytes_left() / stride) +
           " of " + std::to_string(count));
    }
    std::vector<std::size_t> offsets(1, 0);
    for (const PlyProperty& property : element.properties) offsets.push_back(offsets.back() + property.type->bytes);
    constexpr std::size_t kBlock = 1024;  // rows that stay in the cache while their columns are taken one by one
    for (std::size_t row = 0; row < count; row += kBlock)
      for (const PlyColumn& column : wanted.columns) {
        const auto property = static_cast<std::size_t>(column.property);
        const std::size_t first = at_ + row * stride + offsets[property], rows = std::min(kBlock, count - row);
        decode_numbers(*element.properties[property].type, big_endian_, bytes_.data() + first, stride, rows,
                       column.numbers + row);
        if (column.is_coordinate) check(column.numbers + row, rows, first, stride);
      }
    at_ += count * stride;
  }

  void check(const double* coordinates, std::size_t count, std::size_t first, std::size_t stride) {
    for (std::size_t i = 0; i < count; ++i)
      if (std::isinf(coordinates[i])) {
        place_ = first + i * stride;
        fail("found " + to_text(coordinates[i]) + ", expected a finite coordinate");
      }
  }

  void read_one_by_one(const PlyElement& element, const PlyWanted& wanted) {
    std::vector<const PlyColumn*> columns(element.properties.size(), nullptr);
    for (const PlyColumn& column : wanted.columns) columns[static_cast<std::size_t>(column.property)] = &column;
    for (std::int64_t row = 0; row < element.count; ++row)
      for (std::size_t place = 0; place < columns.size(); ++place) {
        const PlyProperty& property = element.properties[place];
        if (property.count_type) {
          read_list(property, static_cast<int>(place) == wanted.list ? &wanted.use_list : nullptr);
          continue;
        }
        const char* const raw = take(property.type->bytes);
        if (columns[place] == nullptr) continue;
        double& number = columns[place]->numbers[row];
        number = decode_number(*property.type, raw, big_endian_);
        if (columns[place]->is_coordinate) check(&number, 1, place_, 0);
      }
  }

  template <class Use>
  void read_list(const PlyProperty& property, const Use* use) {
    std::int64_t count;
    decode_numbers(*property.count_type, big_endian_, take(property.count_type->bytes), 0, 1, &count);
    const std::size_t bytes = property.type->bytes;
    if (count < 0 || static_cast<std::size_t>(count) > bytes_left() / bytes)
      fail("a list of " + std::to_string(count) + " values, expected no more than follow");
    const char* const raw = take(static_cast<std::size_t>(count) * bytes);
    if (use == nullptr) return;
    list_.resize(static_cast<std::size_t>(count));
    decode_numbers(*property.type, big_endian_, raw, bytes, list_.size(), list_.data());
    (*use)(list_);
  }

  const char* take(std::size_t bytes) {
    place_ = at_;
    if (bytes > bytes_left()) fail("the file ends within a value");
    at_ += bytes;
    return bytes_.data() + place_;
  }

  const std::string& path_;
  std::string_view bytes_;
  bool big_endian_;
  std::size_t at_ = 0, place_ = 0;  // where the next value begins, and where the one began that was read last
  std::vector<std::int64_t> list_;
};

}  // namespace

std::unique_ptr<PlyBody> ply_binary_body(const std::string& path, std::string_view bytes, bool big_endian) {
  return std::make_unique<BinaryBody>(path, bytes, big_endian);
}

}  // namespace corral
