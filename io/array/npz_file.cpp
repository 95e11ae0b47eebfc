// SPDX-License-Identifier: MIT
// Zip archives of arrays, as numpy writes them: the central directory at the end of the file lists the members.
#include <algorithm>

#include "io/array/npy_file.h"
#include "io/disk/inflate.h"
#include "io/text/line_reader.h"
#include "io/text/stored_number.h"
#include "kernel/error.h"

namespace corral {
namespace {

constexpr std::uint64_t kIn64Bits = 0xFFFFFFFF;  // a size that stands in the extra field instead

struct Member {
  std::string name;  ///< without .npy
  unsigned method = 0, flags = 0;
  std::uint64_t checksum = 0, compressed = 0, size = 0, header = 0;
};

class Archive {
 public:
  Archive(const std::string& path, std::string_view content) : path_(path), content_(content) { read_directory(); }

  const std::vector<Member>& members() const { return members_; }

  std::string extract(const Member& member) const {
    need(member.header, 30, "a member of the archive");
    if (number(member.header, 4) != 0x04034b50) fail(member.header, "expected the header of a member of the archive");
    const std::uint64_t first = member.header + 30 + number(member.header + 26, 2) + number(member.header + 28, 2);
    need(first, member.compressed, "the content of " + quoted(member.name));
    const std::string_view stored = content_.substr(first, member.compressed);
    if (member.flags & 1u) fail(member.header, quoted(member.name) + " is encrypted, expected a plain archive");
    if (member.method != 0 && member.method != 8)
      fail(member.header, quoted(member.name) + " is compressed by method " + std::to_string(member.method) +
                              ", expected 0 (stored) or 8 (deflate)");
    if (member.method == 0 && member.size != member.compressed)
      fail(member.header, quoted(member.name) + " is stored, but its two sizes differ");
    std::string whole = member.method == 0 ? std::string(stored)
                                           : inflated_member(path_, stored, static_cast<std::size_t>(member.size));
    if (checksum_of(whole) != member.checksum)
      fail(first, quoted(member.name) + " does not have the checksum that the archive states: it is damaged");
    return whole;
  }

 private:
  void read_directory() {
    const std::size_t end = content_.rfind(std::string_view("PK\5\6", 4));
    if (end == std::string_view::npos || content_.size() - end < 22)
      fail(content_.size(), "no archive, or one that was cut short, expected what numpy writes as .npz");
    std::uint64_t count = number(end + 10, 2), at = number(end + 16, 4);
    if ((count == 0xFFFF || at == kIn64Bits) && end >= 20 && number(end - 20, 4) == 0x07064b50) {
      const std::uint64_t record = number(end - 12, 8);
      need(record, 56, "the end of a large archive");
      count = number(record + 32, 8);
      at = number(record + 48, 8);
    }
    for (std::uint64_t i = 0; i < count; ++i) at = read_entry(at);  // each takes bytes, so that the count is bounded
  }

  /// Where the next one begins.
  std::uint64_t read_entry(std::uint64_t at) {
    need(at, 46, "the list of the archive");
    if (number(at, 4) != 0x02014b50) fail(at, "expected the list of the archive");
    const std::uint64_t name = number(at + 28, 2), extra = number(at + 30, 2), comment = number(at + 32, 2);
    need(at + 46, name + extra + comment, "the list of the archive");
    Member member{std::string(content_.substr(at + 46, name)),
                  static_cast<unsigned>(number(at + 10, 2)),
                  static_cast<unsigned>(number(at + 8, 2)),
                  number(at + 16, 4),
                  number(at + 20, 4),
                  number(at + 24, 4),
                  number(at + 42, 4)};
    read_large_sizes(at + 46 + name, extra, member);
    constexpr std::string_view kEnding = ".npy";
    const std::size_t length = member.name.size();
    if (length > kEnding.size() && member.name.compare(length - kEnding.size(), kEnding.size(), kEnding) == 0) {
      member.name.resize(length - kEnding.size());
      members_.push_back(std::move(member));
    }
    return at + 46 + name + extra + comment;
  }

  /// The sizes of 64 bits, those that did not fit in 32, in this order.
  void read_large_sizes(std::uint64_t at, std::uint64_t length, Member& member) const {
    for (const std::uint64_t end = at + length; at + 4 <= end;) {
      std::uint64_t field = at + 4;
      const std::uint64_t next = field + number(at + 2, 2);
      if (number(at, 2) == 1)
        for (std::uint64_t* value : {&member.size, &member.compressed, &member.header})
          if (*value == kIn64Bits && field + 8 <= std::min(next, end)) {
            *value = number(field, 8);
            field += 8;
          }
      at = next;
    }
  }

  std::uint64_t number(std::uint64_t at, std::size_t bytes) const {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(content_[at + i]);
    return value;
  }
  void need(std::uint64_t at, std::uint64_t bytes, const std::string& what) const {
    if (at > content_.size() || bytes > content_.size() - at)
      fail(std::min<std::uint64_t>(at, content_.size()), "the file is too short for " + what);
  }
  [[noreturn]] void fail(std::uint64_t byte, const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(byte), problem);
  }

  const std::string& path_;
  std::string_view content_;
  std::vector<Member> members_;
};

}  // namespace

std::vector<std::string> npz_names(const std::string& path, std::string_view content) {
  std::vector<std::string> names;
  const Archive archive(path, content);
  for (const Member& member : archive.members()) names.push_back(member.name);
  return names;
}

StoredArray parse_npz(const std::string& path, std::string_view content, const std::string& name) {
  const Archive archive(path, content);
  std::string names;
  for (const Member& member : archive.members()) {
    if (member.name == name) return parse_npy(path + ":" + name, archive.extract(member));
    names += (names.empty() ? "" : ", ") + quoted(member.name);
  }
  throw IoError(path, "", "has no array " + name + ", expected one of " + (names.empty() ? "some" : names));
}

}  // namespace corral
