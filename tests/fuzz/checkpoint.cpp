// Changed contents of checkpoints with a valid checksum. An input is a list of changes to a small valid checkpoint:
// each selects a dataset, an operation, a position and bytes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "base/error.h"
#include "case/reader.h"
#include "case/writer.h"
#include "harness.h"
#include "io/hdf5_image.h"
#include "io/temporary_folder.h"
#include "run/checkpoint.h"
#include "support/checkpoint_sets.h"

namespace {

using namespace tailwater;

constexpr const char* case_text =
    "[particles]\nspacing = 0.5\n[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\n[[wall]]\npoints = [[0, 2], [0, 0], [1, 0], "
    "[1, 2]]\n[time]\nend = 1\n";

/// Four fluid particles above one wall particle.
Checkpoint<2> sound_checkpoint() {
  Checkpoint<2> checkpoint;
  Particles<2>& particles = checkpoint.flow.state.particles;
  particles.resize(5);
  particles.owned = particles.size();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const bool is_wall = i == 4;
    particles.position[i] = {0.25 + 0.5 * static_cast<double>(i % 2), 0.25 + 0.5 * static_cast<double>(i / 2)};
    particles.velocity[i].setZero();
    particles.volume[i] = 0.25;
    particles.kind[i] = is_wall ? ParticleKind::wall : ParticleKind::fluid;
    particles.wall_row[i] = is_wall ? 0 : -1;
    particles.id[i] = static_cast<std::int64_t>(i);
  }
  checkpoint.flow.state.time = 0.5;
  checkpoint.flow.state.step = 10;
  checkpoint.flow.state.wall_velocity.assign(1, Vec<2>::Zero());
  checkpoint.flow.parts = Json::object();
  checkpoint.output = {{"steps", 10}};
  checkpoint.rank_log = {1.0, 2.0};
  checkpoint.reference_step = 0.01;
  return checkpoint;
}

struct Set {
  Type type;
  std::size_t columns;
  std::string bytes;
};
using Sets = std::map<std::string, Set>;

template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

std::string bytes_of_set(const Hdf5Reader& reader, const Dataset& set) {
  switch (set.type) {
    case Type::real:
      return bytes_of(reader.get<double>(set.name));
    case Type::whole64:
      return bytes_of(reader.get<std::int64_t>(set.name));
    case Type::whole32:
      return bytes_of(reader.get<std::int32_t>(set.name));
    default:
      return bytes_of(reader.get<std::uint8_t>(set.name));
  }
}

Sets read_sound_sets() {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "sound.h5";
  write_checkpoint(path, sound_checkpoint(), effective_case(read_case_text(case_text, "case.toml")), Communicator());
  const SealedFile file = read_sealed_file(path);
  const Hdf5Reader reader(file.body);
  Sets sets;
  for (const Dataset& set : datasets) sets[set.name] = {set.type, set.columns, bytes_of_set(reader, set)};
  return sets;
}

template <class Value>
void put(Hdf5Writer& writer, const std::string& name, const Set& set) {
  std::vector<Value> values(set.bytes.size() / sizeof(Value));
  set.bytes.copy(reinterpret_cast<char*>(values.data()), values.size() * sizeof(Value));
  const std::size_t columns = set.columns > 0 && values.size() % set.columns == 0 ? set.columns : 1;
  writer.put(name, std::span<const Value>(values), columns);
}

std::string image_of(const Sets& sets) {
  Hdf5Writer writer;
  for (const auto& [name, set] : sets) {
    switch (set.type) {
      case Type::real:
        put<double>(writer, name, set);
        break;
      case Type::whole64:
        put<std::int64_t>(writer, name, set);
        break;
      case Type::whole32:
        put<std::int32_t>(writer, name, set);
        break;
      default:
        put<std::uint8_t>(writer, name, set);
    }
  }
  return std::string(writer.image());
}

SealedFile file_of(const Sets& sets) { return {checkpoint_format, "a program", 1, image_of(sets), "step_10.h5"}; }

/// Splits an input into numbers and bytes; beyond its end all numbers are 0.
class Changes {
 public:
  explicit Changes(std::string_view rest) : rest_(rest) {}

  bool none() const { return rest_.empty(); }
  std::size_t number() {
    if (rest_.empty()) return 0;
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  std::size_t place_in(std::size_t size) { return (256 * number() + number()) % (size + 1); }
  std::string_view bytes() {
    const std::string_view taken = rest_.substr(0, number() % 64);
    rest_.remove_prefix(std::min(rest_.size(), taken.size()));
    return taken;
  }

 private:
  std::string_view rest_;
};

/// Values of eight bytes that are likely to cause errors.
constexpr double strange[] = {0.0,
                              -1.0,
                              1e300,
                              -1e300,
                              std::bit_cast<double>(~std::uint64_t{0} >> 1),
                              1e15,
                              HUGE_VAL,
                              1.0,
                              2.0,
                              std::bit_cast<double>(std::int64_t{1}),
                              5.0,
                              std::bit_cast<double>(std::int64_t{-1})};

void change(Sets& sets, Changes& changes) {
  const Dataset& chosen = datasets[changes.number() % datasets.size()];
  if (!sets.contains(chosen.name)) return;
  Set& set = sets[chosen.name];
  std::string& bytes = set.bytes;
  switch (changes.number() % 8) {
    case 0:
      sets.erase(chosen.name);
      break;
    case 1:
      set.type = static_cast<Type>(changes.number() % 5);
      break;
    case 2:
      set.columns = changes.number() % 4;
      break;
    case 3:
      bytes.resize(changes.place_in(2 * bytes.size() + 64));
      break;
    case 4: {
      const std::size_t place = changes.place_in(bytes.size());
      bytes.erase(place, changes.number());
      break;
    }
    case 5:
      bytes.insert(changes.place_in(bytes.size()), changes.bytes());
      break;
    case 6: {
      const std::size_t place = changes.place_in(bytes.size());
      const std::string_view other = changes.bytes();
      bytes.replace(place, other.size(), other);
      break;
    }
    default: {
      const std::size_t place = changes.place_in(bytes.size()) / sizeof(double) * sizeof(double);
      const double value = strange[changes.number() % std::size(strange)];
      bytes.replace(place, sizeof(value), reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
}

/// Properties of an accepted checkpoint on which a run relies.
template <int Dim>
void require_sound(Checkpoint<Dim> checkpoint) {
  Particles<Dim>& particles = checkpoint.flow.state.particles;
  particles.apply_to_fields([&](const auto&... field) {
    if (((field.size() != particles.owned) || ...)) finding("fields of different sizes", "");
  });
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.position[i].allFinite() || !particles.velocity[i].allFinite() ||
        !std::isfinite(particles.pressure[i]) || !std::isfinite(particles.second_pressure[i]) ||
        !std::isfinite(particles.volume[i]) || !(particles.layer_viscosity[i] >= 0.0) ||
        !(particles.wall_distance[i] >= 0.0)) {
      finding("a number that is none", "");
    }
  }
  if (std::set(particles.id.begin(), particles.id.end()).size() != particles.owned) finding("an id twice", "");
}

template <int Dim>
void read_in(const SealedFile& file) {
  try {
    require_sound(read_checkpoint<Dim>(file, Communicator()));
  } catch (const UserError& error) {
    if (std::string_view(error.what()).find(file.path.string()) == std::string_view::npos) {
      finding("refused without its name", error.what());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Sets sound = read_sound_sets();
  // If the unchanged checkpoint were refused, the test would show nothing.
  [[maybe_unused]] static const Checkpoint<2> read_once = read_checkpoint<2>(file_of(sound), Communicator());
  const std::string text = text_of_input(data, size);
  Changes changes(text);
  const bool is_flat = changes.number() % 4 != 3;
  Sets sets = sound;
  while (!changes.none()) change(sets, changes);
  const SealedFile file = file_of(sets);
  try {
    case_of_checkpoint(file);
  } catch (const UserError&) {
  }
  if (is_flat) {
    read_in<2>(file);
  } else {
    read_in<3>(file);
  }
  return 0;
}
