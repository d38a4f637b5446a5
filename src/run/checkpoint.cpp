#include "run/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <type_traits>

#include "base/error.h"
#include "case/reader.h"
#include "io/hdf5_image.h"
#include "parallel/together.h"
#include "results/provenance.h"
#include "run/checkpoint_text.h"

namespace tailwater {
namespace {

/// Rows in a rank's table of walls are not saved, because they follow from the ids.
constexpr const char* not_saved = nullptr;
constexpr std::array particle_fields{"position", "velocity", "pressure",        "second_pressure", "volume",
                                     "kind",     not_saved,  "layer_viscosity", "wall_distance",   "id"};

/// Bytes for all data except the fields of particles.
constexpr std::size_t room_beside_fields = std::size_t{1} << 20;

/// How an HDF5 file holds a value: as `columns` numbers.
template <class Value>
struct Stored {
  using Number = Value;
  static constexpr std::size_t columns = 1;
};
template <>
struct Stored<ParticleKind> {
  using Number = std::underlying_type_t<ParticleKind>;
  static constexpr std::size_t columns = 1;
};
template <int Dim>
struct Stored<SmallMatrix<Dim, 1>> {
  using Number = double;
  static constexpr std::size_t columns = Dim;
};

template <class Value>
void put(Hdf5Writer& file, const std::string& name, const std::vector<Value>& values) {
  using Number = typename Stored<Value>::Number;
  constexpr std::size_t columns = Stored<Value>::columns;
  static_assert(sizeof(Value) == columns * sizeof(Number));
  file.put(name, std::span(reinterpret_cast<const Number*>(values.data()), columns * values.size()), columns);
}

template <class Value>
std::vector<Value> get(const Hdf5Reader& file, const std::string& name) {
  using Number = typename Stored<Value>::Number;
  constexpr std::size_t columns = Stored<Value>::columns;
  const std::vector<Number> numbers = file.get<Number>(name);
  std::vector<Value> values(numbers.size() / columns);
  const auto* first = reinterpret_cast<const Value*>(numbers.data());
  std::copy(first, first + values.size(), values.begin());
  return values;
}

/// Calls body with each field of particles that is saved, and its name.
template <class AnyParticles, class Body>
void for_each_field(AnyParticles& particles, Body&& body) {
  particles.apply_to_fields([&](auto&... field) {
    static_assert(sizeof...(field) == particle_fields.size(), "every field has a name");
    std::size_t k = 0;
    const auto visit = [&](auto& each) {
      const char* name = particle_fields[k++];
      if (name != not_saved) body(name, each);
    };
    (visit(field), ...);
  });
}

/// Divides `count` particles into parts that are as equal as possible.
std::vector<std::int64_t> equal_shares(std::int64_t count, int ranks) {
  std::vector<std::int64_t> shares;
  for (int q = 0; q < ranks; ++q) shares.push_back(count * (q + 1) / ranks - count * q / ranks);
  return shares;
}

/// The numbers of all ranks; if the number of ranks differs, each gets those of the first rank.
std::vector<double> share_rank_log(const std::vector<double>& saved, std::size_t writers, std::size_t readers) {
  if (readers == writers) return saved;
  const auto first_end = saved.begin() + static_cast<std::ptrdiff_t>(saved.size() / writers);
  std::vector<double> shares;
  for (std::size_t q = 0; q < readers; ++q) shares.insert(shares.end(), saved.begin(), first_end);
  return shares;
}

/// Reports a checkpoint with a right checksum but inconsistent parts as one that another program wrote.
template <class Work>
auto expecting_a_checkpoint(const std::filesystem::path& path, Work&& work) {
  const auto refuse = [&](const std::exception& error) {
    throw IoError("checkpoint '{}' is not from this program: {}; remedy: remove it, to continue from the previous one",
                  path.string(), error.what());
  };
  try {
    return work();
  } catch (const Json::exception& error) {
    refuse(error);
  } catch (const UserError& error) {
    refuse(error);
  }
  throw;
}

/// The condition for every value of a field of particles in a sound run.
template <class Value>
bool is_sound(std::string_view name, const std::vector<Value>& field) {
  return std::all_of(field.begin(), field.end(), [&](const Value& value) {
    if constexpr (std::is_same_v<Value, ParticleKind>) {
      return value == ParticleKind::fluid || value == ParticleKind::wall;
    } else if constexpr (std::is_same_v<Value, double>) {
      return std::isfinite(value) && (name != "volume" || value > 0.0) &&
             ((name != "layer_viscosity" && name != "wall_distance") || value >= 0.0);
    } else if constexpr (std::is_same_v<Value, std::int32_t>) {
      return value >= -1;
    } else if constexpr (std::is_same_v<Value, std::int64_t>) {
      return value >= 0;
    } else {
      return value.allFinite();
    }
  });
}

bool are_unique(std::vector<std::int64_t> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end();
}

template <int Dim>
void require_sound_numbers(const Checkpoint<Dim>& checkpoint) {
  const State<Dim>& state = checkpoint.flow.state;
  require_fit(state.time >= 0.0 && state.step >= 0, "run");
  require_fit(std::isfinite(checkpoint.reference_step) && checkpoint.reference_step >= 0.0, "run");
}

/// The data that the root reads and distributes to the ranks. Empty on the others.
struct Dealt {
  std::int64_t writers = 0;          ///< ranks that wrote it
  std::vector<std::int64_t> shares;  ///< number of particles by rank
  std::vector<std::string> cuts;     ///< by rank; empty if the number of ranks differs from that of the writers
  std::vector<double> rank_logs;
};

Dealt deal(const Hdf5Reader& image, std::size_t ranks) {
  Dealt dealt;
  dealt.shares = image.get<std::int64_t>("owned");
  dealt.cuts.resize(ranks);
  const std::size_t writers = dealt.shares.size();
  dealt.writers = static_cast<std::int64_t>(writers);
  const auto count = static_cast<std::int64_t>(image.get<std::int64_t>("id").size());
  const auto is_share = [count](std::int64_t share) { return share >= 0 && share <= count; };
  require_fit(writers > 0 && std::ranges::all_of(dealt.shares, is_share), "owned");
  dealt.rank_logs = share_rank_log(image.get<double>("rank_log"), writers, ranks);
  if (writers != ranks) {
    const std::int64_t all = std::accumulate(dealt.shares.begin(), dealt.shares.end(), std::int64_t{0});
    dealt.shares = equal_shares(all, static_cast<int>(ranks));
    return dealt;
  }
  const std::string all_cuts = image.text("cuts");
  const std::vector<std::int64_t> cuts_size = image.get<std::int64_t>("cuts_size");
  require_fit(cuts_size.size() == ranks, "cuts_size");
  for (std::size_t q = 0, begin = 0; q < ranks; begin += cuts_size[q++]) {
    require_fit(begin <= all_cuts.size(), "cuts");
    dealt.cuts[q] = all_cuts.substr(begin, cuts_size[q]);
  }
  return dealt;
}

/// An array of the checkpoint, whose values must be those of a sound run.
template <class Value>
std::vector<Value> sound_values(const Hdf5Reader& image, const char* name) {
  std::vector<Value> values = get<Value>(image, name);
  require_fit(is_sound(name, values), name);
  return values;
}

}  // namespace

template <int Dim>
void write_checkpoint(const std::filesystem::path& path, const Checkpoint<Dim>& checkpoint,
                      const std::string& case_text, const Communicator& ranks) {
  const std::vector<std::int64_t> owned =
      ranks.all_gather(static_cast<std::int64_t>(checkpoint.flow.state.particles.owned));
  const std::vector<std::string> cuts = ranks.gather(checkpoint.cuts);
  const std::vector<double> rank_log = ranks.gather(checkpoint.rank_log);
  const Particles<Dim>& particles = checkpoint.flow.state.particles;  // without ghosts: lists are discarded
  std::size_t bytes = room_beside_fields;
  const auto count = static_cast<std::size_t>(std::accumulate(owned.begin(), owned.end(), std::int64_t{0}));
  for_each_field(particles,
                 [&]<class Value>(const char*, const std::vector<Value>&) { bytes += count * sizeof(Value); });
  std::optional<Hdf5Writer> file;
  do_on_root(ranks, [&] { file.emplace(bytes); });
  for_each_field(particles, [&](const char* name, const auto& field) {
    const auto all = ranks.gather(field);
    do_on_root(ranks, [&] { put(*file, name, all); });
  });
  do_on_root(ranks, [&] {
    std::vector<std::int64_t> cuts_size;
    std::string all_cuts;
    for (const std::string& part : cuts) {
      cuts_size.push_back(static_cast<std::int64_t>(part.size()));
      all_cuts += part;
    }
    file->put("case", case_text);
    file->put("run", text_of(checkpoint));
    file->put("owned", std::span<const std::int64_t>(owned));
    put(*file, "wall_velocity", checkpoint.flow.state.wall_velocity);
    put(*file, "probe_memory", checkpoint.probe_memory);
    file->put("rank_log", std::span<const double>(rank_log), checkpoint.rank_log.size());
    file->put("cuts", all_cuts);
    file->put("cuts_size", std::span<const std::int64_t>(cuts_size));
    write_sealed_file(path, {checkpoint_format, version_line(), ranks.size(), ""}, file->image());
  });
}

template <int Dim>
Checkpoint<Dim> read_checkpoint(const SealedFile& file, const Communicator& ranks) {
  Checkpoint<Dim> checkpoint;
  std::optional<Hdf5Reader> image;
  std::string text;
  Dealt dealt;
  do_on_root(ranks, [&] {
    expecting_a_checkpoint(file.path, [&] {
      image.emplace(file.body);
      text = image->text("run");
      take_text(text, checkpoint);
      require_sound_numbers(checkpoint);
      dealt = deal(*image, static_cast<std::size_t>(ranks.size()));
    });
  });
  text = ranks.broadcast(text);
  if (!ranks.is_root()) take_text(text, checkpoint);
  dealt.cuts.resize(static_cast<std::size_t>(ranks.size()));
  checkpoint.cuts = ranks.scatter(dealt.cuts);
  const auto width = static_cast<std::int64_t>(dealt.rank_logs.size() / dealt.cuts.size());
  checkpoint.rank_log = ranks.scatter(dealt.rank_logs, std::vector<std::int64_t>(dealt.cuts.size(), width));

  State<Dim>& state = checkpoint.flow.state;
  for_each_field(state.particles, [&]<class Value>(const char* name, std::vector<Value>& field) {
    std::vector<Value> all;
    do_on_root(ranks, [&] {
      expecting_a_checkpoint(file.path, [&] {
        all = sound_values<Value>(*image, name);
        const auto count = static_cast<std::int64_t>(all.size());
        require_fit(count == std::accumulate(dealt.shares.begin(), dealt.shares.end(), std::int64_t{0}), name);
        if constexpr (std::is_same_v<Value, std::int64_t>) require_fit(are_unique(all), name);
      });
    });
    field = ranks.scatter(all, dealt.shares);
  });
  state.particles.owned = state.particles.size();
  state.particles.resize(state.particles.owned);
  const auto give_to_all = [&]<class Value>(const char* name, std::vector<Value>& values) {
    do_on_root(ranks, [&] { expecting_a_checkpoint(file.path, [&] { values = sound_values<Value>(*image, name); }); });
    const std::string bytes =
        ranks.broadcast({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
    values.resize(bytes.size() / sizeof(Value));
    bytes.copy(reinterpret_cast<char*>(values.data()), bytes.size());
  };
  give_to_all("wall_velocity", state.wall_velocity);
  give_to_all("probe_memory", checkpoint.probe_memory);

  checkpoint.is_repartitioned = ranks.largest(dealt.writers) == ranks.size();
  return checkpoint;
}

CaseSpec case_of_checkpoint(const SealedFile& file) {
  return expecting_a_checkpoint(file.path,
                                [&] { return read_case_text(Hdf5Reader(file.body).text("case"), "its case"); });
}

double time_of_checkpoint(const SealedFile& file) {
  return expecting_a_checkpoint(
      file.path, [&] { return Json::parse(Hdf5Reader(file.body).text("run")).at("time").get<double>(); });
}

TAILWATER_IN_2D_AND_3D(write_checkpoint);
TAILWATER_IN_2D_AND_3D(read_checkpoint);

}  // namespace tailwater
