// The differences between the output of probes and measurements of laboratories. They are made from the tables of the
// probes, so a resumed run reports the same differences as one that was never stopped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "case/spec.h"
#include "results/probe_table.h"

namespace tailwater {

/// A quantity over time, linear between samples.
struct Curve {
  std::vector<double> time;  ///< s, ascending
  std::vector<double> value;

  /// Before the first sample the first value, after the last sample the last value.
  double at(double when) const;
};

/// The difference of computed and measured values, at the times and places of the measured ones. A sample in time has
/// the weight of half the time between its neighbours; those of profiles have equal weights.
struct Difference {
  double rms = 0.0;
  double bias = 0.0;          ///< mean
  double share_inside = 0.0;  ///< fraction of the time in which they are within the scatter
};

/// `shift` [s]: delay at which the computed curve is taken, relative to the measured one.
Difference difference(const Curve& measured, const Curve& computed, double shift, double scatter);

struct MeasurementScore {
  std::string probe;
  std::string column;
  std::string unit;
  std::string file;
  std::size_t samples = 0;  ///< measured samples within the time of the run
  double from = 0.0;        ///< s; the time of the first and the last sample
  double to = 0.0;
  double scatter = 0.0;  ///< 0: unknown
  Difference as_timed;
  double max_shift = 0.0;   ///< s; largest allowed shift
  double best_shift = 0.0;  ///< s, within that: shift with the smallest rms; above 0 where the computed curve is late
  Difference shifted;       ///< difference with that shift

  /// Whether the rms, with the best shift, is no more than the scatter.
  bool is_inside() const { return scatter > 0.0 && shifted.rms <= scatter; }
  /// "connected_m against gauge.csv, 50 samples of 0 to 2 s: rms 0.0041 m, bias +0.0012 m ..."
  std::string words() const;
};

/// The score of a measurement; without samples if the computed curve does not reach a measured time.
MeasurementScore score(const MeasurementTable& measurement, const Curve& computed);
MeasurementScore score(const MeasurementTable& measurement, const ProbeProfiles& computed);

/// The score of each measurement, in the order of the case, from the files in the folder of a run. Throws IoError if a
/// table cannot be read.
std::vector<MeasurementScore> measurement_scores(const CaseSpec& spec, const std::filesystem::path& run);

/// The block "measurements" of the summary.
Json json_of(const std::vector<MeasurementScore>& scores);

}  // namespace tailwater
