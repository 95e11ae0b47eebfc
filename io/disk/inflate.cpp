// SPDX-License-Identifier: MIT
#include "io/disk/inflate.h"

#include <zlib.h>

#include <algorithm>

#include "kernel/error.h"

namespace corral {
namespace {

/// zlib's state, which releases its memory itself.
struct Stream : z_stream {
  explicit Stream(int window_bits) : z_stream() {
    if (inflateInit2(this, window_bits) != Z_OK) throw std::bad_alloc();
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { inflateEnd(this); }
};

constexpr int kGzipOnly = 15 + 16, kBare = -15;  // what is around the deflated data

std::size_t most_of(std::size_t compressed) {
  constexpr std::size_t kFree = std::size_t{64} << 20;
  return std::max(kFree, 100 * compressed);
}

class Inflater {
 public:
  Inflater(const std::string& path, std::string_view compressed) : path_(path), left_(compressed), all_(compressed) {}

  std::string run() {
    const std::size_t most = most_of(all_.size());
    for (bool is_done = false; !is_done;) {
      if (used_ == content_.size())
        content_.resize(std::min(std::max<std::size_t>(4 * all_.size(), 2 * used_) + 1024, most + 1));
      is_done = step();
      if (used_ > most)
        fail("more than " + std::to_string(most) + " bytes come out of " + std::to_string(all_.size()) +
             " compressed ones, expected a mesh");
    }
    content_.resize(used_);
    return std::move(content_);
  }

 private:
  /// Fills what room there is; whether that was the end of the last member.
  bool step() {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
    const auto given = static_cast<uInt>(std::min(left_.size(), kMost));
    const auto room = static_cast<uInt>(std::min(content_.size() - used_, kMost));
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(left_.data()));  // zlib does not write there
    stream_.avail_in = given;
    stream_.next_out = reinterpret_cast<Bytef*>(content_.data() + used_);
    stream_.avail_out = room;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    left_.remove_prefix(given - stream_.avail_in);
    used_ += room - stream_.avail_out;
    if (status == Z_STREAM_END) return !begin_another();
    if (status == Z_MEM_ERROR) throw std::bad_alloc();
    if (status == Z_BUF_ERROR || (status == Z_OK && left_.empty() && stream_.avail_out > 0))
      fail("the file ends here: it was cut short, expected more gzip data");
    if (status != Z_OK)
      fail(std::string("not gzip data") + (stream_.msg ? " (" + std::string(stream_.msg) + ")" : "") +
           ", expected what gzip writes");
    return false;
  }

  /// Files may be joined: what follows and is not zeros is another member.
  bool begin_another() {
    if (left_.find_first_not_of('\0') == std::string_view::npos) return false;
    inflateReset(&stream_);
    return true;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(all_.size() - left_.size()), problem);
  }

  const std::string& path_;
  std::string_view left_, all_;
  Stream stream_{kGzipOnly};
  std::string content_;
  std::size_t used_ = 0;
};

}  // namespace

std::string inflated(const std::string& path, std::string_view compressed) { return Inflater(path, compressed).run(); }

std::string inflated_member(const std::string& path, std::string_view compressed, std::size_t size) {
  constexpr std::size_t kSteepest = 1032;  // bytes that one byte of deflate can stand for
  if (size > most_of(compressed.size()) || size / kSteepest > compressed.size())
    throw IoError(path, "",
                  "promises " + std::to_string(size) + " bytes from " + std::to_string(compressed.size()) +
                      " compressed ones, more than are read");
  constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
  std::string content(size, '\0');
  Stream stream(kBare);
  int status = Z_OK;
  for (std::size_t given = 0, used = 0; status == Z_OK;) {
    const auto input = static_cast<uInt>(std::min(compressed.size() - given, kMost));
    const auto room = static_cast<uInt>(std::min(size - used, kMost));
    stream.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data() + given));  // zlib does not write there
    stream.avail_in = input;
    stream.next_out = reinterpret_cast<Bytef*>(content.data() + used);
    stream.avail_out = room;
    status = inflate(&stream, Z_NO_FLUSH);
    given += input - stream.avail_in;
    used += room - stream.avail_out;
    if (status == Z_STREAM_END && used == size) return content;
  }
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  throw IoError(path, "", "the compressed data are damaged, expected " + std::to_string(size) + " bytes from them");
}

std::uint32_t checksum_of(std::string_view content) {
  uLong sum = crc32(0, nullptr, 0);
  for (constexpr std::size_t kMost = std::size_t{1} << 30; !content.empty();) {
    const std::string_view part = content.substr(0, kMost);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(part.data()), static_cast<uInt>(part.size()));
    content.remove_prefix(part.size());
  }
  return static_cast<std::uint32_t>(sum);
}

}  // namespace corral
