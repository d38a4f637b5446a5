// Tables that name files: the data that are read from the files, and the keys that they exclude.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "base/error.h"
#include "case/key_rules.h"
#include "case/table_rules.h"
#include "case_files/linked_files.h"

namespace tailwater {

namespace {

/// Calls body, which reads the file that `key` names, and reports problems of the file at that key.
template <class Body>
void read_linked(std::string_view key, TableReader& reader, Body&& body) {
  const toml::node* node = reader.given(key);
  if (node == nullptr || reader.is_wrong(key)) return;
  try {
    body();
  } catch (const UserError& error) {
    reader.wrong("linked-file", key, error.what());
  }
}

/// Makes the name of a file absolute and records its checksum; a file with another checksum is refused.
void keep_linked(std::string& file, std::string& checksum, std::string_view checksum_key, TableReader& reader) {
  const std::filesystem::path path = reader.linked(file);
  const std::string found = checksum_of_file(path);
  if (!checksum.empty() && checksum != found) {
    throw InputError(
        "{} has changed: its checksum is {}, and the case requires {}; restore the file for which the case was made, "
        "or start a new run without {}",
        path.string(), found, checksum, checksum_key);
  }
  file = path.string();
  checksum = found;
}

/// A run begins at t = 0. The end of the series is checked when the end of the run has been read.
void require_start(const TimeSeries& series) {
  if (series.time.front() <= 0.0) return;
  throw InputError("{}:{}: begins at t = {:.9g} s, but the motion begins at 0; add a line for t = 0", series.file,
                   series.line.front(), series.time.front());
}

/// The checks across tables report a series that is too short, when the end of the run is known.
void read_series(std::string& file, std::string& checksum, std::span<const SeriesColumn> columns, TimeSeries& series,
                 TableReader& reader) {
  if (file.empty()) return;
  read_linked("file", reader, [&] {
    keep_linked(file, checksum, "checksum", reader);
    series = read_time_series(file, columns);
  });
}

/// Whether a key has a value in the case or in a file.
struct Given {
  std::string_view key;
  bool in_case;
  bool in_file;
  bool anywhere() const { return in_case || in_file; }
};

/// Checks that no quantity is given both in the case and in a file.
void check_given_once(std::span<const Given> quantities, TableReader& reader) {
  for (const Given& quantity : quantities) {
    if (!quantity.in_case || !quantity.in_file) continue;
    reader.wrong("value-in-case-and-file", quantity.key, "the file has a column {} as well; remove one of the two",
                 quantity.key);
  }
}

Given given(std::string_view key, const std::optional<Varying>& value, const TimeSeries& series, std::size_t column) {
  return {key, value.has_value(), column < series.columns.size() && !series.columns[column].empty()};
}

}  // namespace

void read_linked_files(FluidTable& fluid, TableReader& reader) {
  if (fluid.shape != BlockShape::mesh || reader.is_wrong("shape")) return;
  read_linked("file", reader, [&] { keep_linked(fluid.file, fluid.checksum, "checksum", reader); });
}

void read_linked_files(PorousTable& porous, TableReader& reader) {
  if (porous.shape != RegionShape::mesh || reader.is_wrong("shape")) return;
  read_linked("file", reader, [&] { keep_linked(porous.file, porous.checksum, "checksum", reader); });
}

void read_linked_files(WallTable& wall, TableReader& reader) {
  if (!wall.points_file.empty() && wall.points.empty() && !reader.is_wrong("shape")) {
    read_linked("points_file", reader, [&] {
      wall.points = read_points_file(reader.linked(wall.points_file));
      const std::size_t least = min_corners(wall.shape, reader.dimension());
      if (wall.points.size() < least) {
        throw InputError("has too few points for shape = \"{}\": {}; give at least {}", name_of(wall.shape),
                         wall.points.size(), least);
      }
      wall.points_file.clear();
    });
  }
  const bool is_mesh = wall.shape == WallShape::mesh || (wall.shape == WallShape::plate && !wall.file.empty());
  if (is_mesh && !reader.is_wrong("shape")) {
    read_linked("file", reader, [&] { keep_linked(wall.file, wall.checksum, "checksum", reader); });
  }
  if (wall.motion.empty()) return;
  read_linked("motion", reader, [&] {
    constexpr std::array<SeriesColumn, 4> columns{{{"x"}, {"y"}, {"z"}, {"angle", Measure::angle}}};
    keep_linked(wall.motion, wall.motion_checksum, "motion_checksum", reader);
    wall.series = read_time_series(wall.motion, columns);
    require_start(wall.series);
    if (reader.dimension() == 2 && !wall.series.columns[2].empty()) {
      throw InputError("{} has a column z, but case.dimension = 2; remove it", wall.motion);
    }
  });
  if (reader.dimension() == 3 && !reader.is_wrong("motion") && !wall.series.columns[3].empty()) {
    check_turning_in_3d(wall, "motion", reader);
  }
}

void read_linked_files(GateTable& gate, TableReader& reader) {
  if (gate.motion != GateMotion::file || gate.file.empty()) return;
  read_linked("file", reader, [&] {
    constexpr std::array<SeriesColumn, 1> columns{{{"displacement"}}};
    keep_linked(gate.file, gate.checksum, "checksum", reader);
    gate.series = read_time_series(gate.file, columns);
    require_start(gate.series);
  });
}

namespace {

/// Checks that an opening that absorbs waves has a level, whose variation absorbs them.
void check_absorbing(double absorbing, const Given& level, TableReader& reader) {
  if (absorbing == 0.0 || level.anywhere() || reader.is_wrong("absorbing") || reader.is_wrong("level")) return;
  reader.wrong("absorbing-without-level", "absorbing", "has no effect without a level; give a level, or remove it");
}

}  // namespace

void read_linked_files(InletTable& inlet, TableReader& reader) {
  static constexpr std::array<SeriesColumn, 3> columns{
      {{"discharge", Measure::discharge}, {"velocity", Measure::speed}, {"level"}}};
  read_series(inlet.file, inlet.checksum, columns, inlet.series, reader);
  if (reader.is_wrong("file")) return;
  const Given discharge = given("discharge", inlet.discharge, inlet.series, 0);
  const Given velocity = given("velocity", inlet.velocity, inlet.series, 1);
  const Given level = given("level", inlet.level, inlet.series, 2);
  check_given_once(std::array{discharge, velocity, level}, reader);
  const bool has_wrong_key = reader.is_wrong("discharge") || reader.is_wrong("velocity") || reader.is_wrong("level");
  if (!has_wrong_key && !discharge.anywhere() && !velocity.anywhere() && !level.anywhere()) {
    reader.missing("inlet-without-flow", "discharge",
                   "give a discharge, a velocity or a level, or a file with one of them");
  }
  if (discharge.anywhere() && velocity.anywhere()) {
    const std::string_view key = velocity.in_case ? "velocity" : discharge.in_case ? "discharge" : "file";
    reader.wrong("inlet-flow-twice", key, "an inlet has either a discharge or a velocity; remove one of the two");
  }
  if (inlet.profile && !discharge.anywhere() && !velocity.anywhere()) {
    reader.wrong("inlet-profile-without-flow", "profile",
                 "has no effect at an inlet with a level alone; give a discharge or a velocity, or remove it");
  }
  check_absorbing(inlet.absorbing, level, reader);
  if (inlet.absorbing > 0.0 && level.anywhere() && (discharge.anywhere() || velocity.anywhere()) &&
      !reader.is_wrong("absorbing")) {
    reader.wrong("absorbing-beside-flow", "absorbing",
                 "has no effect at an inlet with a discharge or a velocity; remove it");
  }
}

void read_linked_files(OutletTable& outlet, TableReader& reader) {
  static constexpr std::array<SeriesColumn, 1> columns{{{"level"}}};
  read_series(outlet.file, outlet.checksum, columns, outlet.series, reader);
  if (reader.is_wrong("file")) return;
  const Given level = given("level", outlet.level, outlet.series, 0);
  check_given_once(std::array{level}, reader);
  check_absorbing(outlet.absorbing, level, reader);
}

void read_linked_files(MeasurementTable& measurement, TableReader& reader) {
  read_linked("file", reader, [&] { keep_linked(measurement.file, measurement.checksum, "checksum", reader); });
}

}  // namespace tailwater
