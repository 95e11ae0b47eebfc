// SPDX-License-Identifier: MIT
#include "apps/study/content_store.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>

#include "kernel/error.h"

namespace corral {
namespace {

constexpr std::size_t kHashSize = 32;

/// A row of bytes that is written and read value by value, in the byte order of the machine.
class ByteWriter {
 public:
  void put(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  void put(std::int64_t value) { put(&value, sizeof value); }
  void put(double value) { put(&value, sizeof value); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Throws InvalidInput when the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  void get(void* data, std::size_t size) {
    if (size > bytes_.size() - at_) throw InvalidInput("ByteReader", "bytes", "too few", "as many as are read");
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  std::int64_t integer() {
    std::int64_t value = 0;
    get(&value, sizeof value);
    return value;
  }
  double number() {
    double value = 0;
    get(&value, sizeof value);
    return value;
  }
  /// A count of things of that size, no more than the bytes that are left can hold.
  int count(std::size_t size_of_each) {
    const std::int64_t value = integer();
    if (value < 0 || static_cast<std::uint64_t>(value) > (bytes_.size() - at_) / size_of_each)
      throw InvalidInput("ByteReader", "count", std::to_string(value), "no more than the bytes hold");
    return static_cast<int>(value);
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Matrix>
void put_matrix(ByteWriter& writer, const Matrix& matrix) {
  writer.put(static_cast<std::int64_t>(matrix.rows()));
  writer.put(matrix.data(), sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size()));
}

template <class Matrix>
Matrix get_matrix(ByteReader& reader, Eigen::Index columns, bool is_column_major = false) {
  using Scalar = typename Matrix::Scalar;
  const int rows = reader.count(sizeof(Scalar) * static_cast<std::size_t>(columns));
  Matrix matrix = is_column_major ? Matrix(columns, rows) : Matrix(rows, columns);
  reader.get(matrix.data(), sizeof(Scalar) * static_cast<std::size_t>(matrix.size()));
  return matrix;
}

void put_list(ByteWriter& writer, const Indices& list) {
  writer.put(static_cast<std::int64_t>(list.size()));
  writer.put(list.data(), sizeof(int) * list.size());
}

Indices get_indices(ByteReader& reader) {
  Indices list(static_cast<std::size_t>(reader.count(sizeof(int))));
  reader.get(list.data(), sizeof(int) * list.size());
  return list;
}

void put_frames(ByteWriter& writer, const LocalReferenceFrames& frames) {
  writer.put(static_cast<std::int64_t>(frames.size()));
  for (const LocalReferenceFrame& frame : frames) writer.put(frame.data(), 9 * sizeof(double));
}

LocalReferenceFrames get_frames(ByteReader& reader) {
  LocalReferenceFrames frames(static_cast<std::size_t>(reader.count(9 * sizeof(double))));
  for (LocalReferenceFrame& frame : frames) reader.get(frame.data(), 9 * sizeof(double));
  return frames;
}

/// What a reader makes of the bytes, if it wants exactly all of them.
template <class Value, class Read>
std::optional<Value> read_whole(const std::optional<std::string>& bytes, const Read& read) {
  if (!bytes) return std::nullopt;
  try {
    ByteReader reader(*bytes);
    Value value = read(reader);
    if (reader.at_end()) return value;
  } catch (const InvalidInput&) {  // damaged: made anew
  }
  return std::nullopt;
}

std::string digits_of(const XXH128_hash_t& hash) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t half : {hash.high64, hash.low64})
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(half >> shift) & 15];
  return text;
}

}  // namespace

std::string content_hash(const std::string& content) { return digits_of(XXH3_128bits(content.data(), content.size())); }

struct ContentHasher::State {
  XXH3_state_t* state = XXH3_createState();
  State() {
    if (!state || XXH3_128bits_reset(state) != XXH_OK) throw std::bad_alloc();
  }
  ~State() { XXH3_freeState(state); }
};

ContentHasher::ContentHasher() : state_(std::make_unique<State>()) {}
ContentHasher::~ContentHasher() = default;

void ContentHasher::add(const std::string& piece) { XXH3_128bits_update(state_->state, piece.data(), piece.size()); }

std::string ContentHasher::hash() const { return digits_of(XXH3_128bits_digest(state_->state)); }

ContentStore::ContentStore(std::string folder, std::uint64_t limit_bytes) : folder_(std::move(folder), limit_bytes) {}

std::optional<std::string> ContentStore::load(const std::string& key) const {
  const std::optional<std::string> file = folder_.load(key);
  if (!file || file->size() < kHashSize) return std::nullopt;
  std::string content = file->substr(kHashSize);
  if (file->compare(0, kHashSize, content_hash(content)) != 0) return std::nullopt;
  return content;
}

void ContentStore::save(const std::string& key, const std::string& content) const {
  folder_.save(key, content_hash(content) + content);
}

std::optional<Descriptors> ContentStore::descriptors(const std::string& key) const {
  return read_whole<Descriptors>(load(key), [](ByteReader& reader) {
    Descriptors found;
    found.vertices = get_indices(reader);
    found.frames = get_frames(reader);
    const int size = reader.count(1);
    found.features = get_matrix<Eigen::MatrixXd>(reader, std::max(size, 1), true);
    found.dropped_small_support = static_cast<int>(reader.integer());
    found.dropped_no_frame = static_cast<int>(reader.integer());
    found.dropped_no_histogram = static_cast<int>(reader.integer());
    return found;
  });
}

void ContentStore::put(const std::string& key, const Descriptors& descriptors) const {
  ByteWriter writer;
  put_list(writer, descriptors.vertices);
  put_frames(writer, descriptors.frames);
  writer.put(static_cast<std::int64_t>(descriptors.features.rows()));
  writer.put(static_cast<std::int64_t>(descriptors.features.cols()));
  writer.put(descriptors.features.data(), sizeof(double) * static_cast<std::size_t>(descriptors.features.size()));
  writer.put(static_cast<std::int64_t>(descriptors.dropped_small_support));
  writer.put(static_cast<std::int64_t>(descriptors.dropped_no_frame));
  writer.put(static_cast<std::int64_t>(descriptors.dropped_no_histogram));
  save(key, writer.bytes());
}

std::optional<StoredMatches> ContentStore::matches(const std::string& key) const {
  return read_whole<StoredMatches>(load(key), [](ByteReader& reader) {
    StoredMatches stored;
    CorrespondenceSet& found = stored.matches;
    found.source_points = get_matrix<Points>(reader, 3);
    found.target_points = get_matrix<Points>(reader, 3);
    found.source_frames = get_frames(reader);
    found.target_frames = get_frames(reader);
    found.source_keypoints = get_indices(reader);
    found.target_keypoints = get_indices(reader);
    found.feature_distance = get_matrix<Eigen::VectorXd>(reader, 1);
    found.second_feature_distance = get_matrix<Eigen::VectorXd>(reader, 1);
    found.resolution = reader.number();
    Eigen::Vector3d centroid;
    for (double& coordinate : centroid) coordinate = reader.number();
    found.source_centroid = centroid;
    found.validate();
    stored.source_keypoints = static_cast<int>(reader.integer());
    return stored;
  });
}

void ContentStore::put(const std::string& key, const StoredMatches& stored) const {
  const CorrespondenceSet& matches = stored.matches;
  ByteWriter writer;
  put_matrix(writer, matches.source_points);
  put_matrix(writer, matches.target_points);
  put_frames(writer, matches.source_frames);
  put_frames(writer, matches.target_frames);
  put_list(writer, matches.source_keypoints);
  put_list(writer, matches.target_keypoints);
  put_matrix(writer, matches.feature_distance);
  put_matrix(writer, matches.second_feature_distance);
  writer.put(matches.resolution);
  for (const double coordinate : matches.source_centroid_or_mean()) writer.put(coordinate);
  writer.put(static_cast<std::int64_t>(stored.source_keypoints));
  save(key, writer.bytes());
}

}  // namespace corral
