// Writes field files of known content into the folder named on the command line, and beside each file its content as
// NAME.csv, with which read_back.py compares it. On three ranks each file is written by all of them.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <vector>

#include "base/fp_traps.h"
#include "io/csv_writer.h"
#include "io/pvd_series.h"
#include "io/vtp_writer.h"
#include "io/write_file.h"
#include "linear/session.h"
#include "parallel/communicator.h"

namespace tailwater {
namespace {

template <int Dim>
struct Sample {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<double> pressure;
  std::vector<std::int64_t> id;

  /// Numbers without a pattern, so that a shifted or swapped array differs.
  Sample(std::size_t count, std::size_t first) {
    for (std::size_t i = first; i < first + count; ++i) {
      const double a = static_cast<double>(i);
      Vec<Dim> x;
      Vec<Dim> u;
      for (int d = 0; d < Dim; ++d) {
        x[d] = std::sin(a + 10.0 * d) / 3.0;
        u[d] = std::cos(a * (d + 1)) * 7.0;
      }
      position.push_back(x);
      velocity.push_back(u);
      pressure.push_back(std::fmod(a * 977.0, 1013.0) / 7.0 - 20.0);
      id.push_back(5'000'000'000 + static_cast<std::int64_t>(i) * 3);
    }
  }

  ParticleFields<Dim> fields() const {
    return {position,
            {{"pressure", std::span<const double>(pressure)},
             {"velocity", std::span<const Vec<Dim>>(velocity)},
             {"id", std::span<const std::int64_t>(id)}}};
  }
};

/// Writes the values of the particles as a table.
template <int Dim>
void write_table(const std::filesystem::path& path, const Sample<Dim>& sample) {
  CsvWriter csv(path, {"x", "y", "z", "pressure", "u", "v", "w", "id"});
  for (std::size_t i = 0; i < sample.id.size(); ++i) {
    std::array<double, 8> row{};
    for (int d = 0; d < Dim; ++d) {
      row[d] = sample.position[i][d];
      row[4 + d] = sample.velocity[i][d];
    }
    row[3] = sample.pressure[i];
    row[7] = static_cast<double>(sample.id[i]);
    csv.write(row);
  }
}

/// Writes one file to which rank r gives `counts[r]` particles, and its contents as a table.
template <int Dim>
void write_sample(const std::filesystem::path& folder, const std::vector<std::size_t>& counts, int compression,
                  const Communicator& ranks) {
  const std::string name = fmt::format("{}d_{}_level{}", Dim, fmt::join(counts, "+"), compression);
  const std::size_t before = std::accumulate(counts.begin(), counts.begin() + ranks.rank(), std::size_t{0});
  const Sample<Dim> own(counts[ranks.rank()], before);
  write_vtp(folder / (name + ".vtp"), 0.1 + 0.2, encode_piece(own.fields(), compression), compression, ranks);
  if (!ranks.is_root()) return;
  write_table(folder / (name + ".csv"), Sample<Dim>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), 0));
}

/// Particles per rank. One rank: none; one; exactly one 32 KiB block of Int64; many blocks. Three ranks: none; an empty
/// rank at each end and in the middle.
std::vector<std::vector<std::size_t>> samples(int ranks) {
  if (ranks == 1) return {{0}, {1}, {4096}, {10000}};
  return {{0, 0, 0}, {0, 1, 0}, {5000, 0, 7000}, {4096, 10000, 10}};
}

template <int Dim>
void write_samples(const std::filesystem::path& folder, const Communicator& ranks) {
  for (const int compression : {0, 1, 9}) {
    for (const std::vector<std::size_t>& counts : samples(ranks.size())) {
      write_sample<Dim>(folder, counts, compression, ranks);
    }
  }
}

/// Writes a series of files; every rank has `count` particles of each file.
void write_series(const std::filesystem::path& folder, const Communicator& ranks) {
  std::filesystem::create_directory(folder / "series");
  PvdSeries series(folder / "series", "fields", 1);
  std::string table = "time_s,particles\n";
  for (const std::size_t count : {10, 20, 0, 30}) {
    const double time = static_cast<double>(series.size()) / 3.0;
    series.write(time, Sample<2>(count, 0).fields(), ranks);
    table += fmt::format("{},{}\n", time, count * ranks.size());
  }
  if (ranks.is_root()) write_text_file(folder / "series.csv", table);
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FOLDER\n", argv[0]);
    return 2;
  }
  const tailwater::LinearSession session;
  const tailwater::Communicator ranks = tailwater::Communicator::world();
  tailwater::enable_fp_traps();
  const std::filesystem::path folder = argv[1];
  tailwater::write_samples<2>(folder, ranks);
  tailwater::write_samples<3>(folder, ranks);
  tailwater::write_series(folder, ranks);
}
