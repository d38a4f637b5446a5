// Writes field files of known content into the folder named on the command line, and beside each file what is in it as
// NAME.csv, for read_back.py to compare.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/fp_traps.h"
#include "io/csv_writer.h"
#include "io/pvd_series.h"
#include "io/vtp_writer.h"

namespace tailwater {
namespace {

template <int Dim>
struct Sample {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<double> pressure;
  std::vector<std::int64_t> id;

  /// Numbers without a pattern that a shifted or swapped array could share.
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

/// One file of pieces with `counts` particles each, and its contents as text.
template <int Dim>
void write_sample(const std::filesystem::path& folder, const std::vector<std::size_t>& counts, int compression) {
  std::string name = fmt::format("{}d_{}_level{}", Dim, fmt::join(counts, "+"), compression);
  CsvWriter csv(folder / (name + ".csv"), {"x", "y", "z", "pressure", "u", "v", "w", "id"});
  std::vector<EncodedPiece> pieces;
  std::size_t first = 0;
  for (const std::size_t count : counts) {
    const Sample<Dim> sample(count, first);
    pieces.push_back(encode_piece(sample.fields(), compression));
    for (std::size_t i = 0; i < count; ++i) {
      std::array<double, 8> row{};
      for (int d = 0; d < Dim; ++d) {
        row[d] = sample.position[i][d];
        row[4 + d] = sample.velocity[i][d];
      }
      row[3] = sample.pressure[i];
      row[7] = static_cast<double>(sample.id[i]);
      csv.write(row);
    }
    first += count;
  }
  write_vtp(folder / (name + ".vtp"), 0.1 + 0.2, pieces, compression);
}

template <int Dim>
void write_samples(const std::filesystem::path& folder) {
  for (const int compression : {0, 1, 9}) {
    // None; one; exactly one 32 KiB block of Int64; many blocks; pieces as from several ranks, one of them empty.
    for (const std::vector<std::size_t>& counts :
         {std::vector<std::size_t>{0}, {1}, {4096}, {30000}, {5000, 0, 7000}}) {
      write_sample<Dim>(folder, counts, compression);
    }
  }
}

void write_series(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "series");
  PvdSeries series(folder / "series", "fields", 1);
  CsvWriter csv(folder / "series.csv", {"time_s", "particles"});
  for (const std::size_t count : {10, 20, 0, 30}) {
    const double time = static_cast<double>(series.size()) / 3.0;
    const Sample<2> sample(count, 0);
    series.write(time, sample.fields());
    csv.write(std::array{time, static_cast<double>(count)});
  }
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FOLDER\n", argv[0]);
    return 2;
  }
  tailwater::enable_fp_traps();
  const std::filesystem::path folder = argv[1];
  tailwater::write_samples<2>(folder);
  tailwater::write_samples<3>(folder);
  tailwater::write_series(folder);
}
