// The waves at a gauge during a run, for its summary: heights between crest and trough, and periods between upward
// crossings of the mean so far. `tailwater waves` evaluates windows, spectra and several gauges.
#pragma once

#include <memory>
#include <vector>

namespace tailwater {

class WaveRecord {
 public:
  /// Starts a record. The level must exceed the mean by `band` [m] on either side before a crossing counts, which
  /// excludes small oscillations of particles.
  explicit WaveRecord(double band);

  /// The whole state, for a checkpoint; it grows by one number with each wave.
  const std::shared_ptr<std::vector<double>>& memory() const { return memory_; }

  /// Adds a level [m] at a time [s] after the last.
  void add(double now, double reading);

  /// The totals of a depth probe. Empty before the first reading, and only the first three without waves.
  std::vector<double> totals() const;

 private:
  enum Slot {
    readings,
    first_time,
    time,
    level,
    integral,
    least,
    largest,
    side,
    crest,
    trough,
    rise,
    first,
    last,
    slots
  };
  double& at(Slot slot) const { return (*memory_)[slot]; }
  double mean() const;
  void close_wave();

  std::shared_ptr<std::vector<double>> memory_ = std::make_shared<std::vector<double>>();
  double band_;
};

}  // namespace tailwater
