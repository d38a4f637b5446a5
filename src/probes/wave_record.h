// The waves at a gauge while a run goes on: heights between crest and trough and periods between upward crossings of
// the mean so far, in the summary of the run. What a window, a spectrum or several gauges say is left to `tailwater
// waves`.
#pragma once

#include <memory>
#include <vector>

namespace tailwater {

class WaveRecord {
 public:
  /// A new one. The level must go beyond the mean by `band` [m] on either side before a crossing counts, which leaves
  /// out the trembling of particles.
  explicit WaveRecord(double band);

  /// All that it knows, for a checkpoint; one number more with each wave.
  const std::shared_ptr<std::vector<double>>& memory() const { return memory_; }

  /// A level [m] at a time [s] after the last.
  void add(double now, double reading);

  /// The totals of a depth probe. Nothing before the first reading, and only the first three without waves.
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
