// How far what probes have written is from what laboratories have measured. Made from the tables of the probes, so a
// run that goes on after a stop tells the same as one that was never stopped.
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

  /// Before the first sample its value, after the last one that.
  double at(double when) const;
};

/// Of computed values less measured ones, at the times and places of the measured ones. Each counts as the time that it
/// stands for, half of that to its neighbours; those of profiles count alike.
struct Difference {
  double rms = 0.0;
  double bias = 0.0;          ///< mean
  double share_inside = 0.0;  ///< of the time in which they are within the scatter
};

/// `shift` [s]: how much later than the measured curve the computed one is taken.
Difference difference(const Curve& measured, const Curve& computed, double shift, double scatter);

struct MeasurementScore {
  std::string probe;
  std::string column;
  std::string unit;
  std::string file;
  std::size_t samples = 0;  ///< measured ones within the time of the run
  double from = 0.0;        ///< s; the time of the first and the last of them
  double to = 0.0;
  double scatter = 0.0;  ///< 0: not known
  Difference as_timed;
  double most_shift = 0.0;  ///< s, that is allowed
  double best_shift = 0.0;  ///< s, within that: where the rms is least; above 0 where the computed curve is late
  Difference shifted;       ///< with that

  /// Whether the rms, with the best shift, is no more than the scatter.
  bool is_inside() const { return scatter > 0.0 && shifted.rms <= scatter; }
  /// "connected_m against gauge.csv, 50 samples of 0 to 2 s: rms 0.0041 m, bias +0.0012 m ..."
  std::string words() const;
};

/// Of what was measured and what was computed; of what does not reach a measured time, without samples.
MeasurementScore score(const MeasurementTable& measurement, const Curve& computed);
MeasurementScore score(const MeasurementTable& measurement, const ProbeProfiles& computed);

/// Of each measurement, in the order of the case, from what is in the folder of a run. Throws IoError if a table cannot
/// be read.
std::vector<MeasurementScore> measurement_scores(const CaseSpec& spec, const std::filesystem::path& run);

/// The block "measurements" of the summary.
Json json_of(const std::vector<MeasurementScore>& scores);

}  // namespace tailwater
