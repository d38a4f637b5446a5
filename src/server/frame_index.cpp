#include "server/frame_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "io/run_folder.h"
#include "io/vtp_reader.h"
#include "view/frame.h"

namespace tailwater {
namespace {

/// Longer than the head of any frame with a few moving objects.
constexpr std::int64_t bytes_of_head = 65536;

const std::string stream_folder = "view";
const std::string fields_folder = "fields";

/// The number in 00012.frame.
std::optional<std::uint32_t> index_in(std::string_view name) {
  if (!name.ends_with(frame_ending)) return std::nullopt;
  name.remove_suffix(frame_ending.size());
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  return error == std::errc{} && end == name.data() + name.size() ? std::optional(index) : std::nullopt;
}

std::string name_of_frame(std::uint32_t index) { return fmt::format("{:05}{}", index, frame_ending); }

/// Values of a field as whole numbers from 0 to `largest`, for the range from `low` to `high`.
template <class Whole>
std::vector<Whole> as_whole(const std::vector<double>& values, double low, double high, double largest) {
  std::vector<Whole> whole(values.size());
  const double scale = high > low ? largest / (high - low) : 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    whole[i] = static_cast<Whole>(std::clamp((values[i] - low) * scale + 0.5, 0.0, largest));
  }
  return whole;
}

/// Smallest and largest finite value; 0 and 1 if there is none.
std::pair<double, double> range_of(std::vector<double>& values) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (double& value : values) {
    if (!std::isfinite(value)) value = 0.0;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low > high ? std::pair(0.0, 1.0) : std::pair(low, high > low ? high : low + 1.0);
}

/// The component `first` of all points, in the order given by `order`.
std::vector<double> picked(const VtpFile::Array& array, std::size_t first, const std::vector<std::size_t>& order) {
  std::vector<double> values;
  values.reserve(order.size());
  for (const std::size_t i : order) values.push_back(array.values[i * array.components + first]);
  return values;
}

}  // namespace

std::string frame_of_fields(std::string_view bytes, const std::string& name, std::uint32_t index,
                            std::size_t dimension) {
  const VtpFile file = read_vtp_bytes(bytes, name);
  std::vector<std::size_t> order(file.count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Without ids a particle is identified by its place in the file, which is in the order of ids.
  std::vector<std::int64_t> id(order.begin(), order.end());
  if (const auto ids = file.fields.find("id"); ids != file.fields.end()) {
    for (std::size_t i = 0; i < id.size(); ++i) {
      const double number = ids->second.values[i];
      if (!std::isfinite(number) || std::abs(number) > 0x1p53) {
        throw IoError("cannot read '{}': an id is no whole number", name);
      }
      id[i] = static_cast<std::int64_t>(number);
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return id[i]; });
  }
  Frame frame;
  frame.head.index = index;
  frame.head.time = file.time;
  FrameParticles& particles = frame.particles;
  for (const std::size_t i : order) particles.id.push_back(id[i]);
  for (std::size_t d = 0; d < dimension; ++d) {
    std::vector<double> x = picked(file.points, d, order);
    const auto [low, high] = range_of(x);
    frame.head.scale.low.push_back(low);
    frame.head.scale.high.push_back(high);
    particles.place.push_back(as_whole<std::uint16_t>(x, low, high, 65535.0));
  }
  for (const char* field : {"pressure", "velocity"}) {
    const auto found = file.fields.find(field);
    std::vector<double> values(file.count, 0.0);
    if (found != file.fields.end()) {
      for (std::size_t c = 0; c < found->second.components; ++c) {
        const std::vector<double> component = picked(found->second, c, order);
        for (std::size_t i = 0; i < values.size(); ++i) {
          values[i] = found->second.components == 1 ? component[i] : std::hypot(values[i], component[i]);
        }
      }
    }
    const auto [low, high] = range_of(values);
    frame.head.scale.ranges.push_back({static_cast<float>(low), static_cast<float>(high)});
    particles.scalar.push_back(as_whole<std::uint8_t>(values, low, high, 255.0));
  }
  return encode_frame(frame, {});
}

FrameIndex::Found FrameIndex::list_stream() const {
  Found found;
  for (const std::string& name : folder_.names_in(stream_folder)) {
    if (const std::optional<std::uint32_t> index = index_in(name)) found[*index] = name;
  }
  return found;
}

std::optional<FrameEntry> FrameIndex::read_entry(const std::string& name) const {
  const std::optional<FileMark> mark = folder_.mark_of({stream_folder, name});
  const std::optional<OpenFile> file = folder_.open({stream_folder, name});
  if (!mark || !file) return std::nullopt;
  try {
    const FrameSummary summary = read_frame_head(file->read(0, bytes_of_head));
    const auto whole = static_cast<std::int64_t>(summary.payload_begin + summary.payload_size);
    if (whole != file->size()) return std::nullopt;
    return FrameEntry{.time = summary.head.time,
                      .is_key = summary.head.order == 0,
                      .bytes = file->size(),
                      .mark = *mark,
                      .field_file = {}};
  } catch (const IoError&) {
    return std::nullopt;
  }
}

void FrameIndex::cut_from(std::uint32_t index, News& news) {
  frames_.erase(frames_.lower_bound(index), frames_.end());
  news.is_cut = true;
  news.cut_time = frames_.empty() ? News{}.cut_time : frames_.rbegin()->second.time;
}

FrameIndex::News FrameIndex::look() {
  const Found found = list_stream();
  const bool knows_fields = !frames_.empty() && !frames_.begin()->second.field_file.empty();
  if (found.empty() && (frames_.empty() || knows_fields)) return look_at_fields();
  return look_at_stream(found);
}

FrameIndex::News FrameIndex::look_at_stream(const Found& found) {
  News news;
  // A run only appends files. It has been resumed only if the last known frame has changed.
  const auto is_same = [&](const auto& known) {
    const auto there = found.find(known.first);
    return there != found.end() && folder_.mark_of({stream_folder, there->second}) == known.second.mark;
  };
  if (!frames_.empty() && !is_same(*frames_.rbegin())) {
    const auto other = std::find_if_not(frames_.begin(), frames_.end(), is_same);
    if (other != frames_.end()) cut_from(other->first, news);
  }
  const std::uint32_t first = frames_.empty() ? 0 : frames_.rbegin()->first + 1;
  for (auto file = found.lower_bound(first); file != found.end(); ++file) {
    const std::optional<FrameEntry> entry = read_entry(file->second);
    if (!entry) continue;
    frames_[file->first] = *entry;
    news.added.push_back(file->first);
  }
  return news;
}

FrameIndex::News FrameIndex::look_at_fields() {
  News news;
  const std::optional<FileMark> list = folder_.mark_of({fields_folder, "fields.pvd"});
  if (list == field_list_) return news;
  field_list_ = list;
  std::vector<PvdEntry> entries;
  try {
    entries = read_pvd(folder_.text_of({fields_folder, "fields.pvd"}));
  } catch (const IoError&) {
    return news;
  }
  for (std::uint32_t k = 0; k < entries.size(); ++k) {
    const std::optional<FileMark> mark = folder_.mark_of({fields_folder, entries[k].file});
    if (!mark) continue;
    const auto known = frames_.find(k);
    if (known != frames_.end() && known->second.mark == *mark) continue;
    if (known != frames_.end()) cut_from(k, news);
    frames_[k] = {
        .time = entries[k].time, .is_key = true, .bytes = mark->size, .mark = *mark, .field_file = entries[k].file};
    news.added.push_back(k);
  }
  if (!frames_.empty() && frames_.rbegin()->first >= entries.size()) {
    cut_from(static_cast<std::uint32_t>(entries.size()), news);
  }
  return news;
}

std::optional<std::string> FrameIndex::bytes_of(std::uint32_t index) const {
  const auto known = frames_.find(index);
  if (known == frames_.end()) return std::nullopt;
  if (known->second.field_file.empty()) {
    const std::optional<OpenFile> file = folder_.open({stream_folder, name_of_frame(index)});
    return file ? std::optional(file->read()) : std::nullopt;
  }
  // In two dimensions the third coordinate of all points is 0.
  const std::string bytes = folder_.text_of({fields_folder, known->second.field_file});
  const std::string case_text = folder_.text_of({std::string(effective_case_name)});
  const std::size_t dimension = case_text.find("\ndimension = 3") != case_text.npos ? 3 : 2;
  try {
    return frame_of_fields(bytes, known->second.field_file, index, dimension);
  } catch (const IoError&) {
    return std::nullopt;
  }
}

}  // namespace tailwater
