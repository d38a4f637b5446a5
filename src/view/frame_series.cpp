#include "view/frame_series.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>

#include "base/box.h"
#include "base/eigen.h"
#include "base/error.h"
#include "base/for_each.h"
#include "base/input_file.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {
namespace {

/// A viewer that jumps to a frame decodes all frames since the last key frame.
constexpr int frames_per_key = 10;

/// Resolution of places, in dx: smaller errors are invisible, and more digits cost bytes.
constexpr double min_quantum_over_spacing = 1.0 / 128.0;

/// Margin of the box around the water and the walls, as a fraction of their extent.
constexpr double room_in_box = 0.05;

/// Margin of the range of a scalar beyond its present values, as a fraction of their extent.
constexpr double room_in_range = 0.25;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file = open_input_file(path);
  if (!file) throw IoError("cannot read '{}'", path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<double> numbers_of(const AffineMap<2>& pose) {
  return {pose.constant[0], pose.constant[1], std::atan2(pose.linear(1, 0), pose.linear(0, 0))};
}
std::vector<double> numbers_of(const AffineMap<3>& pose) {
  const Eigen::Quaterniond turn{Eigen::Matrix3d(to_eigen(pose.linear))};
  return {pose.constant[0], pose.constant[1], pose.constant[2], turn.w(), turn.x(), turn.y(), turn.z()};
}

/// The least values and the negatives of the largest ones, over all ranks: of each coordinate, then of each scalar.
template <int Dim>
std::vector<double> extremes_of(const WaterNow<Dim>& water, const Communicator& ranks) {
  std::vector<double> extremes;
  const auto add = [&](auto&& value) {
    double least = std::numeric_limits<double>::max();
    double largest = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < water.id.size(); ++i) {
      least = std::min(least, value(i));
      largest = std::max(largest, value(i));
    }
    extremes.insert(extremes.end(), {least, -largest});
  };
  for (int d = 0; d < Dim; ++d) add([&](std::size_t i) { return water.position[i][d]; });
  for (const std::span<const double> scalar : water.scalars) add([&](std::size_t i) { return scalar[i]; });
  ranks.min_of_each(extremes);
  return extremes;
}

/// Whether values with these extremes fit into the scale.
bool fits(const FrameScale& scale, std::span<const double> extremes) {
  const std::size_t dimension = scale.low.size();
  for (std::size_t d = 0; d < dimension; ++d) {
    if (extremes[2 * d] < scale.low[d] || -extremes[2 * d + 1] > scale.high[d]) return false;
  }
  for (std::size_t s = 0; s < scale.ranges.size(); ++s) {
    const std::size_t k = 2 * (dimension + s);
    if (extremes[k] < scale.ranges[s][0] || -extremes[k + 1] > scale.ranges[s][1]) return false;
  }
  return true;
}

/// The range of a scalar: its present values, and a margin for later ones.
std::array<float, 2> range_around(double least, double largest) {
  if (least > largest) return {0.0F, 1.0F};  // there is no water
  const double room = room_in_range * (largest - least);
  // Rounded outwards, so that all values of the frame are in its range.
  const auto low = std::nextafter(static_cast<float>(least - room), -1e30F);
  const auto high = std::nextafter(static_cast<float>(largest + room), 1e30F);
  return {low, high};
}

/// The order of ascending ids, which are unique. Ids of water have few gaps: a table by id is then ten times as fast as
/// a sort by comparisons.
std::vector<std::uint32_t> order_by_id(const std::vector<std::int64_t>& id) {
  const std::size_t count = id.size();
  std::vector<std::uint32_t> order;
  if (count == 0) return order;
  std::int64_t first = id.front();
  std::int64_t last = first;
  for (const std::int64_t one : id) {
    first = std::min(first, one);
    last = std::max(last, one);
  }
  const auto width = static_cast<std::size_t>(last - first) + 1;
  if (width <= 4 * count) {
    constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
    order.assign(width, nobody);
    for (std::size_t i = 0; i < count; ++i)
      order[static_cast<std::size_t>(id[i] - first)] = static_cast<std::uint32_t>(i);
    if (width > count) std::erase(order, nobody);
    return order;
  }
  order.resize(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return id[a] < id[b]; });
  return order;
}

/// Calls visit(column) for the id, each coordinate, and each scalar.
template <class Visit>
void for_each_column(FrameParticles& particles, const Visit& visit) {
  visit(particles.id);
  for (std::vector<std::uint16_t>& place : particles.place) visit(place);
  for (std::vector<std::uint8_t>& scalar : particles.scalar) visit(scalar);
}

/// Gathers the particles of all ranks, rank after rank, on the root; none on the others. In one message.
void gather_all(FrameParticles& particles, const Communicator& ranks) {
  if (ranks.is_alone()) return;
  std::string bytes;
  std::size_t bytes_of_one = 0;
  for_each_column(particles, [&](auto& column) {
    bytes.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(column[0]));
    bytes_of_one += sizeof(column[0]);
    column.clear();
  });
  for (const std::string& part : ranks.gather(bytes)) {
    if (part.empty()) continue;
    const std::size_t count = part.size() / bytes_of_one;
    const char* next = part.data();
    for_each_column(particles, [&](auto& column) {
      column.resize(column.size() + count);
      std::memcpy(column.data() + column.size() - count, next, count * sizeof(column[0]));
      next += count * sizeof(column[0]);
    });
  }
}

template <class Number>
std::vector<Number> in_order(const std::vector<Number>& column, const std::vector<std::uint32_t>& order) {
  std::vector<Number> sorted(order.size());
  for_each(order.size(), [&](std::size_t k) { sorted[k] = column[order[k]]; });
  return sorted;
}

}  // namespace

template <int Dim>
FrameSeries<Dim>::FrameSeries(std::filesystem::path folder, double spacing, const Box<Dim>& walls)
    : folder_(std::move(folder)), spacing_(spacing), walls_(walls) {}

template <int Dim>
std::filesystem::path FrameSeries<Dim>::file_of(std::size_t index) const {
  return folder_ / fmt::format("{:05}{}", index, frame_ending);
}

template <int Dim>
void FrameSeries<Dim>::write_into_folder(const std::filesystem::path& path, const std::string& text) const {
  std::error_code ignored;  // writing the next file reports the error
  std::filesystem::create_directory(folder_, ignored);
  try {
    write_text_file(path, text);
  } catch (const IoError&) {
    const bool is_gone = std::filesystem::create_directory(folder_, ignored);
    if (!is_gone) throw;
    write_text_file(path, text);
  }
}

template <int Dim>
void FrameSeries<Dim>::write_beside(std::string_view name, const std::string& text, const Communicator& ranks) const {
  do_on_root(ranks, [&] { write_into_folder(folder_ / name, text); });
}

template <int Dim>
FrameScale FrameSeries<Dim>::scale_for(std::span<const double> extremes, std::size_t scalars) const {
  FrameScale scale;
  for (int d = 0; d < Dim; ++d) {
    double low = extremes[2 * d];
    double high = -extremes[2 * d + 1];
    if (!walls_.isEmpty()) {
      low = std::min(low, walls_.min()[d]);
      high = std::max(high, walls_.max()[d]);
    }
    if (low > high) low = high = 0.0;  // there is neither water nor a wall
    const double quantum =
        std::max((1.0 + 2.0 * room_in_box) * (high - low) / largest_place, min_quantum_over_spacing * spacing_);
    const double middle = 0.5 * (low + high);
    scale.low.push_back(middle - 0.5 * largest_place * quantum);
    scale.high.push_back(middle + 0.5 * largest_place * quantum);
  }
  for (std::size_t s = 0; s < scalars; ++s) {
    scale.ranges.push_back(range_around(extremes[2 * (Dim + s)], -extremes[2 * (Dim + s) + 1]));
  }
  return scale;
}

template <int Dim>
FrameParticles FrameSeries<Dim>::gather(const WaterNow<Dim>& water, const Communicator& ranks) const {
  const std::size_t count = water.id.size();
  FrameParticles all{.id = {water.id.begin(), water.id.end()}, .place = {}, .scalar = {}};
  for (int d = 0; d < Dim; ++d) {
    std::vector<std::uint16_t>& place = all.place.emplace_back(count);
    const double low = scale_.low[d];
    const double per_metre = largest_place / (scale_.high[d] - low);
    for_each(count, [&](std::size_t i) {
      place[i] = static_cast<std::uint16_t>(static_cast<int>((water.position[i][d] - low) * per_metre + 0.5));
    });
  }
  for (std::size_t s = 0; s < water.scalars.size(); ++s) {
    std::vector<std::uint8_t>& scalar = all.scalar.emplace_back(count);
    const double low = scale_.ranges[s][0];
    const double per_unit = largest_scalar / (static_cast<double>(scale_.ranges[s][1]) - low);
    for_each(count, [&](std::size_t i) {
      scalar[i] = static_cast<std::uint8_t>(static_cast<int>((water.scalars[s][i] - low) * per_unit + 0.5));
    });
  }
  gather_all(all, ranks);
  const std::vector<std::uint32_t> order = order_by_id(all.id);
  for_each_column(all, [&](auto& column) { column = in_order(column, order); });
  return all;
}

template <int Dim>
void FrameSeries<Dim>::write(const WaterNow<Dim>& water, const Communicator& ranks) {
  const std::vector<double> extremes = extremes_of(water, ranks);
  const bool is_key = since_key_ < 0 || since_key_ + 1 >= frames_per_key || !fits(scale_, extremes);
  if (is_key) scale_ = scale_for(extremes, water.scalars.size());
  since_key_ = is_key ? 0 : since_key_ + 1;
  Frame frame{{.order = std::min(since_key_, 2),
               .index = static_cast<std::uint32_t>(count_),
               .time = water.time,
               .scale = scale_,
               .poses = {}},
              gather(water, ranks)};
  for (const AffineMap<Dim>& pose : water.poses) frame.head.poses.push_back(numbers_of(pose));
  do_on_root(ranks, [&] { write_into_folder(file_of(count_), encode_frame(frame, before_)); });
  before_.last_but_one = std::exchange(before_.last, std::move(frame.particles));
  ++count_;
}

/// The frame before the next one, decoded from the last key frame on; empty if that is impossible.
template <int Dim>
std::optional<Frame> FrameSeries<Dim>::read_back(std::size_t count) {
  try {
    std::size_t first = count;
    std::vector<std::string> files;  // the last one first
    int order = 1;
    while (order != 0) {
      if (first == 0 || files.size() == frames_per_key) return std::nullopt;
      files.push_back(read_file(file_of(--first)));
      order = read_frame_head(files.back()).head.order;
    }
    Frame frame;
    for (auto file = files.rbegin(); file != files.rend(); ++file) {  // NOLINT(modernize-loop-convert): from the last
      frame = decode_frame(*file, before_);
      if (frame.head.dimension() != Dim) return std::nullopt;
      before_.last_but_one = std::exchange(before_.last, frame.particles);
    }
    since_key_ = static_cast<int>(files.size()) - 1;
    return frame;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

template <int Dim>
void FrameSeries<Dim>::go_on(std::size_t count, const Communicator& ranks) {
  count_ = count;
  std::vector<double> known;  // for all ranks, from the last frame: the frames since its key frame, and its scale
  do_on_root(ranks, [&] {
    std::error_code error;
    for (std::size_t i = count; std::filesystem::exists(file_of(i), error); ++i) remove_file(file_of(i));
    const std::optional<Frame> last = read_back(count);
    if (!last) return;
    const FrameScale& scale = last->head.scale;
    known = {static_cast<double>(since_key_)};
    known.insert(known.end(), scale.low.begin(), scale.low.end());
    known.insert(known.end(), scale.high.begin(), scale.high.end());
    for (const std::array<float, 2>& range : scale.ranges) known.insert(known.end(), range.begin(), range.end());
  });
  const std::string bytes =
      ranks.broadcast({reinterpret_cast<const char*>(known.data()), known.size() * sizeof(double)});
  known.resize(bytes.size() / sizeof(double));
  bytes.copy(reinterpret_cast<char*>(known.data()), bytes.size());
  since_key_ = known.empty() ? -1 : static_cast<int>(known[0]);
  if (known.empty()) return;
  scale_.low.assign(known.begin() + 1, known.begin() + 1 + Dim);
  scale_.high.assign(known.begin() + 1 + Dim, known.begin() + 1 + 2 * Dim);
  scale_.ranges.clear();
  for (std::size_t k = 1 + 2 * Dim; k + 1 < known.size(); k += 2) {
    scale_.ranges.push_back({static_cast<float>(known[k]), static_cast<float>(known[k + 1])});
  }
}

template class FrameSeries<2>;
template class FrameSeries<3>;

}  // namespace tailwater
