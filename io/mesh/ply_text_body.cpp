// SPDX-License-Identifier: MIT
#include <cmath>

#include "io/mesh/mesh_cleanup.h"
#include "io/mesh/ply_body.h"

namespace corral {
namespace {

/// Numbers of a list that nothing reads may be of any size.
std::int64_t whole(double number) { return std::abs(number) < 9e18 ? static_cast<std::int64_t>(number) : 0; }

class TextBody : public PlyBody {
 public:
  explicit TextBody(LineReader& reader) : reader_(reader) { reader_.allow_open_end(); }

  std::size_t bytes_left() const override { return reader_.rest().size(); }
  // A digit and a separator per property; the last line may lack its end.
  std::size_t smallest(const PlyElement& element) const override { return 2 * element.properties.size(); }

  void read(const PlyElement& element, const PlyWanted& wanted) override {
    std::vector<const PlyColumn*> columns(element.properties.size(), nullptr);
    for (const PlyColumn& column : wanted.columns) columns[static_cast<std::size_t>(column.property)] = &column;
    for (std::int64_t row = 0; row < element.count; ++row) {
      if (!reader_.next())
        reader_.fail_at_end("element " + quoted(element.name) + " " + std::to_string(row) + " of " +
                            std::to_string(element.count));
      for (std::size_t place = 0; place < columns.size(); ++place) {
        const PlyProperty& property = element.properties[place];
        if (property.count_type) {
          read_list(property);
          if (static_cast<int>(place) == wanted.list) wanted.use_list(list_);
        } else if (const PlyColumn* column = columns[place]) {
          column->numbers[row] = value(*property.type, column->is_coordinate);
        } else {
          value(*property.type, false);
        }
      }
      if (!reader_.take().empty()) fail_for_width();
    }
  }

  void note_end(std::vector<std::string>& notes) override { note_ending(reader_, "element", notes); }
  [[noreturn]] void fail(const std::string& problem) const override { reader_.fail(problem); }

 private:
  double value(const PlyType& type, bool is_coordinate) {
    const std::string_view field = reader_.take();
    if (field.empty()) fail("found " + std::to_string(reader_.fields().size()) + " values, expected more");
    return is_coordinate && type.kind == 'f' ? reader_.coordinate(field)
                                             : parse_number(reader_, field, type, type.name);
  }

  void read_list(const PlyProperty& property) {
    const double count = value(*property.count_type, false);
    // The shortest value takes a character and a separator.
    if (!(count >= 0) || count > static_cast<double>(reader_.untaken().size() / 2))
      fail("a list of " + std::to_string(whole(count)) + " values, expected no more than follow");
    list_.clear();
    for (auto i = static_cast<std::int64_t>(count); i > 0; --i) list_.push_back(whole(value(*property.type, false)));
  }

  [[noreturn]] void fail_for_width() {
    std::size_t more = 1;
    while (!reader_.take().empty()) ++more;
    const std::size_t found = reader_.fields().size();
    reader_.fail("found " + std::to_string(found) + " values, expected " + std::to_string(found - more));
  }

  LineReader& reader_;
  std::vector<std::int64_t> list_;
};

}  // namespace

std::unique_ptr<PlyBody> ply_text_body(LineReader& reader) { return std::make_unique<TextBody>(reader); }

}  // namespace corral
