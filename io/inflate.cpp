// SPDX-License-Identifier: MIT
#include "io/inflate.h"

#include <zlib.h>

#include <algorithm>

#include "kernel/error.h"

namespace corral {
namespace {

/// zlib's state, which releases its memory itself.
struct Stream : z_stream {
  Stream() : z_stream() {
    constexpr int kGzipOnly = 15 + 16;
    if (inflateInit2(this, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { inflateEnd(this); }
};

class Inflater {
 public:
  Inflater(const std::string& path, std::string_view compressed) : path_(path), left_(compressed), all_(compressed) {}

  std::string run() {
    constexpr std::size_t kFree = std::size_t{64} << 20;
    const std::size_t most = std::max(kFree, 100 * all_.size());
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
  Stream stream_;
  std::string content_;
  std::size_t used_ = 0;
};

}  // namespace

std::string inflated(const std::string& path, std::string_view compressed) { return Inflater(path, compressed).run(); }

}  // namespace corral
