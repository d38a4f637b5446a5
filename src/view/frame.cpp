#include "view/frame.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "base/assert.h"
#include "base/error.h"
#include "io/deflate.h"

namespace tailwater {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are written in the machine's byte order");

constexpr std::string_view magic = "TWVF";

/// Compression level of libdeflate. The higher one makes frames 6 % smaller and takes ten times as long.
constexpr int level_of(Deflation deflation) { return deflation == Deflation::quick ? 1 : 9; }

/// Upper bound of the size of a frame of a run.
constexpr std::size_t largest_raw_size = std::size_t{1} << 31U;
/// About the largest expansion by deflate; a damaged head must not cause the allocation of more memory.
constexpr std::size_t largest_inflation = 1100;

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

std::size_t numbers_of_pose(std::size_t dimension) { return dimension == 2 ? 3 : 7; }

// ---- Plain numbers in bytes.

template <class Number>
void put(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

void put_varint(std::string& bytes, std::uint64_t number) {
  while (number >= 128) {
    bytes.push_back(static_cast<char>(number % 128 + 128));
    number /= 128;
  }
  bytes.push_back(static_cast<char>(number));
}

/// Reads numbers from the front of bytes. Throws IoError if the bytes end too early.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes), size_(bytes.size()) {}

  template <class Number>
  Number take() {
    Number number;
    std::memcpy(&number, take_bytes(sizeof(Number)).data(), sizeof(Number));
    return number;
  }
  std::uint64_t take_varint() {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = take<std::uint8_t>();
      number |= static_cast<std::uint64_t>(byte % 128) << shift;
      if (byte < 128) return number;
    }
    throw IoError("not a frame: a number has too many bytes");
  }
  std::string_view take_bytes(std::size_t count) {
    if (count > rest_.size()) throw IoError("not a whole frame: its bytes end too early");
    const std::string_view bytes = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return bytes;
  }
  std::size_t taken() const { return size_ - rest_.size(); }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t size_;
};

// ---- Sets of particles.

/// For each particle of a frame, its index in an earlier frame with other particles; `nowhere` for new particles.
std::vector<std::uint32_t> numbers_in(const std::vector<std::int64_t>& earlier, const std::vector<std::int64_t>& now) {
  std::vector<std::uint32_t> places(now.size(), nowhere);
  std::size_t k = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    while (k < earlier.size() && earlier[k] < now[i]) ++k;
    if (k < earlier.size() && earlier[k] == now[i]) places[i] = static_cast<std::uint32_t>(k);
  }
  return places;
}

/// Ascending numbers: the first, then differences.
template <class Number>
void put_ascending(std::string& bytes, const std::vector<Number>& numbers) {
  Number before = 0;
  for (const Number number : numbers) {
    put_varint(bytes, static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(before));
    before = number;
  }
}

template <class Number>
std::vector<Number> take_ascending(Taker& bytes, std::size_t count) {
  if (count > bytes.left()) throw IoError("not a whole frame: its bytes end too early");
  std::vector<Number> numbers(count);
  Number before = 0;
  for (Number& number : numbers) {
    number = static_cast<Number>(static_cast<std::uint64_t>(before) + bytes.take_varint());
    before = number;
  }
  return numbers;
}

void put_changes(std::string& bytes, const std::vector<std::int64_t>& now, const std::vector<std::int64_t>& last) {
  std::vector<std::int64_t> removed;  // places in the list of the last frame
  std::vector<std::int64_t> added;    // ids
  if (now != last) {
    std::size_t k = 0;
    for (const std::int64_t id : now) {
      for (; k < last.size() && last[k] < id; ++k) removed.push_back(static_cast<std::int64_t>(k));
      if (k < last.size() && last[k] == id) {
        ++k;
      } else {
        added.push_back(id);
      }
    }
    for (; k < last.size(); ++k) removed.push_back(static_cast<std::int64_t>(k));
  }
  put(bytes, static_cast<std::uint32_t>(removed.size()));
  put_ascending(bytes, removed);
  put(bytes, static_cast<std::uint32_t>(added.size()));
  put_ascending(bytes, added);
}

std::vector<std::int64_t> take_changes(Taker& bytes, const std::vector<std::int64_t>& last) {
  const auto removed = take_ascending<std::int64_t>(bytes, bytes.take<std::uint32_t>());
  const auto added = take_ascending<std::int64_t>(bytes, bytes.take<std::uint32_t>());
  std::vector<std::int64_t> kept;
  std::size_t r = 0;
  for (std::size_t k = 0; k < last.size(); ++k) {
    if (r < removed.size() && removed[r] == static_cast<std::int64_t>(k)) {
      ++r;
    } else {
      kept.push_back(last[k]);
    }
  }
  std::vector<std::int64_t> now(kept.size() + added.size());
  std::merge(kept.begin(), kept.end(), added.begin(), added.end(), now.begin());
  return now;
}

// ---- Predictions.

/// An earlier frame, whose numbers are read in the order of a later one.
class Earlier {
 public:
  Earlier(const FrameParticles& earlier, const std::vector<std::int64_t>& now) : is_same_(earlier.id == now) {
    if (!is_same_) places_ = numbers_in(earlier.id, now);
  }

  /// A column of the earlier frame; new particles have the number of `otherwise`.
  template <class Number>
  std::vector<Number> column(const std::vector<Number>& earlier, std::vector<Number> otherwise) const {
    if (is_same_) return earlier;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i] != nowhere) otherwise[i] = earlier[places_[i]];
    }
    return otherwise;
  }
  /// Sets the entries of new particles to 0.
  template <class Number>
  void forget_new(std::vector<Number>& column) const {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i] == nowhere) column[i] = 0;
    }
  }

 private:
  bool is_same_;
  std::vector<std::uint32_t> places_;
};

/// Predicts the columns of a frame from the previous frames, in the order of its particles.
class Predictor {
 public:
  Predictor(int order, const std::vector<std::int64_t>& now, const FramesBefore& before)
      : before_(before), count_(now.size()) {
    if (order >= 1) last_.emplace(before.last, now);
    if (order >= 2) last_but_one_.emplace(before.last_but_one, now);
  }

  std::vector<std::uint16_t> places(std::size_t d) const {
    std::vector<std::uint16_t> predicted(count_);
    if (!last_ || d >= before_.last.place.size()) return predicted;
    predicted = last_->column(before_.last.place[d], std::move(predicted));
    if (!last_but_one_ || d >= before_.last_but_one.place.size()) return predicted;
    const std::vector<std::uint16_t> earlier = last_but_one_->column(before_.last_but_one.place[d], predicted);
    for (std::size_t i = 0; i < count_; ++i) predicted[i] = static_cast<std::uint16_t>(2U * predicted[i] - earlier[i]);
    last_->forget_new(predicted);
    return predicted;
  }
  std::vector<std::uint8_t> scalars(std::size_t s) const {
    std::vector<std::uint8_t> none(count_);
    if (!last_ || s >= before_.last.scalar.size()) return none;
    return last_->column(before_.last.scalar[s], std::move(none));
  }

 private:
  const FramesBefore& before_;
  std::size_t count_;
  std::optional<Earlier> last_;
  std::optional<Earlier> last_but_one_;
};

/// Maps small numbers of either sign to small numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
std::uint16_t zigzag(std::uint16_t residual) {
  const auto sign = static_cast<std::uint16_t>(residual & 0x8000U ? 0xFFFFU : 0U);
  return static_cast<std::uint16_t>((residual << 1U) ^ sign);
}
std::uint16_t from_zigzag(std::uint16_t code) {
  const auto sign = static_cast<std::uint16_t>(code & 1U ? 0xFFFFU : 0U);
  return static_cast<std::uint16_t>((code >> 1U) ^ sign);
}

std::string planes_of(const Frame& frame, const FramesBefore& before) {
  const FrameParticles& now = frame.particles;
  const int order = frame.head.order;
  const std::size_t count = now.size();
  std::string planes;
  planes.reserve(count * (2 * now.place.size() + now.scalar.size() + 1) + 16);
  if (order == 0) {
    put_ascending(planes, now.id);
  } else {
    put_changes(planes, now.id, before.last.id);
  }
  const Predictor predictor(order, now.id, before);
  for (std::size_t d = 0; d < now.place.size(); ++d) {
    const std::size_t begin = planes.size();
    planes.resize(begin + 2 * count);
    char* low = planes.data() + begin;
    char* high = low + count;
    const std::uint16_t* place = now.place[d].data();
    std::vector<std::uint16_t> codes = predictor.places(d);
    for (std::size_t i = 0; i < count; ++i) {
      const auto residual = static_cast<std::uint16_t>(place[i] - codes[i]);
      codes[i] = order == 0 ? residual : zigzag(residual);
    }
    for (std::size_t i = 0; i < count; ++i) low[i] = static_cast<char>(codes[i] & 0xFFU);
    for (std::size_t i = 0; i < count; ++i) high[i] = static_cast<char>(codes[i] >> 8U);
  }
  for (std::size_t s = 0; s < now.scalar.size(); ++s) {
    std::vector<std::uint8_t> residuals = predictor.scalars(s);
    for (std::size_t i = 0; i < count; ++i) residuals[i] = static_cast<std::uint8_t>(now.scalar[s][i] - residuals[i]);
    planes.append(reinterpret_cast<const char*>(residuals.data()), count);
  }
  return planes;
}

FrameParticles particles_from(std::string_view planes, const FrameSummary& summary, const FramesBefore& before) {
  const std::size_t count = summary.count;
  const int order = summary.head.order;
  Taker bytes(planes);
  FrameParticles now;
  now.id = order == 0 ? take_ascending<std::int64_t>(bytes, count) : take_changes(bytes, before.last.id);
  if (now.size() != count) throw IoError("not a frame that follows those before: its particles are others");
  const Predictor predictor(order, now.id, before);
  for (std::size_t d = 0; d < summary.head.dimension(); ++d) {
    const std::string_view low = bytes.take_bytes(count);
    const std::string_view high = bytes.take_bytes(count);
    std::vector<std::uint16_t>& place = now.place.emplace_back(predictor.places(d));
    for (std::size_t i = 0; i < count; ++i) {
      const auto code =
          static_cast<std::uint16_t>(static_cast<std::uint8_t>(low[i]) + 256U * static_cast<std::uint8_t>(high[i]));
      const std::uint16_t residual = order == 0 ? code : from_zigzag(code);
      place[i] = static_cast<std::uint16_t>(residual + place[i]);
    }
  }
  for (std::size_t s = 0; s < summary.head.scale.ranges.size(); ++s) {
    const std::string_view residual = bytes.take_bytes(count);
    std::vector<std::uint8_t>& scalar = now.scalar.emplace_back(predictor.scalars(s));
    for (std::size_t i = 0; i < count; ++i) {
      scalar[i] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(residual[i]) + scalar[i]);
    }
  }
  if (bytes.left() > 0) throw IoError("not a frame: there are bytes behind its particles");
  return now;
}

// ---- zlib.

std::string inflated(std::string_view bytes, std::size_t raw_size) {
  std::string raw(raw_size, '\0');
  uLongf size = raw.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(raw.data()), &size,
                                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK || size != raw_size) throw IoError("not a frame: its bytes are damaged");
  return raw;
}

}  // namespace

std::string encode_frame(const Frame& frame, const FramesBefore& before, Deflation deflation) {
  const FrameHead& head = frame.head;
  const std::string planes = planes_of(frame, before);
  TAILWATER_ASSERT(planes.size() < largest_raw_size, "a frame has less than 2 GB");
  const std::string payload = deflated(planes, level_of(deflation));
  std::string bytes(magic);
  bytes.reserve(256 + payload.size());
  put(bytes, static_cast<std::uint16_t>(frame_format));
  put(bytes, static_cast<std::uint8_t>(head.dimension()));
  put(bytes, static_cast<std::uint8_t>(head.order));
  put(bytes, head.index);
  put(bytes, static_cast<std::uint32_t>(frame.particles.size()));
  put(bytes, head.time);
  put(bytes, static_cast<std::uint32_t>(head.poses.size()));
  put(bytes, static_cast<std::uint32_t>(head.scale.ranges.size()));
  for (const double x : head.scale.low) put(bytes, x);
  for (const double x : head.scale.high) put(bytes, x);
  for (const auto& [low, high] : head.scale.ranges) {
    put(bytes, low);
    put(bytes, high);
  }
  for (const std::vector<double>& pose : head.poses) {
    TAILWATER_ASSERT(pose.size() == numbers_of_pose(head.dimension()), "a pose has 3 numbers in 2D, 7 in 3D");
    for (const double number : pose) put(bytes, number);
  }
  put(bytes, static_cast<std::uint32_t>(payload.size()));
  put(bytes, static_cast<std::uint32_t>(planes.size()));
  return bytes + payload;
}

FrameSummary read_frame_head(std::string_view bytes) {
  Taker taker(bytes);
  if (taker.take_bytes(magic.size()) != magic) throw IoError("not a frame: it begins with other bytes");
  const auto format = taker.take<std::uint16_t>();
  if (format != frame_format) throw IoError("a frame of format {}; known is {}", format, frame_format);
  FrameSummary summary;
  FrameHead& head = summary.head;
  const std::size_t dimension = taker.take<std::uint8_t>();
  head.order = taker.take<std::uint8_t>();
  if (dimension < 2 || dimension > 3 || head.order > 2) throw IoError("not a frame: its head is damaged");
  head.index = taker.take<std::uint32_t>();
  summary.count = taker.take<std::uint32_t>();
  head.time = taker.take<double>();
  const auto poses = taker.take<std::uint32_t>();
  const auto scalars = taker.take<std::uint32_t>();
  for (std::size_t d = 0; d < dimension; ++d) head.scale.low.push_back(taker.take<double>());
  for (std::size_t d = 0; d < dimension; ++d) head.scale.high.push_back(taker.take<double>());
  for (std::uint32_t s = 0; s < scalars; ++s) {
    const auto low = taker.take<float>();
    head.scale.ranges.push_back({low, taker.take<float>()});
  }
  for (std::uint32_t p = 0; p < poses; ++p) {
    std::vector<double>& pose = head.poses.emplace_back();
    for (std::size_t k = 0; k < numbers_of_pose(dimension); ++k) pose.push_back(taker.take<double>());
  }
  summary.payload_size = taker.take<std::uint32_t>();
  summary.raw_size = taker.take<std::uint32_t>();
  summary.payload_begin = taker.taken();
  return summary;
}

Frame decode_frame(std::string_view bytes, const FramesBefore& before) {
  const FrameSummary summary = read_frame_head(bytes);
  if (bytes.size() - summary.payload_begin != summary.payload_size ||
      summary.raw_size > largest_inflation * (summary.payload_size + 1)) {
    throw IoError("not a whole frame: its number of bytes differs from that in its header");
  }
  const std::string planes = inflated(bytes.substr(summary.payload_begin), summary.raw_size);
  return {summary.head, particles_from(planes, summary, before)};
}

}  // namespace tailwater
