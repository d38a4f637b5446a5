// The probes of a case, and the files they write during the run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "case/spec.h"
#include "io/csv_writer.h"
#include "io/run_folder.h"
#include "probes/context.h"

namespace tailwater {

/// A probe: its reading and the times of its readings.
template <int Dim>
struct Probe {
  std::string name;
  ProbeType type;
  Reading<Dim> reading;
  double interval = 0.0;      ///< s; 0: at every step
  std::vector<double> times;  ///< s, ascending; if any, they replace the interval
};

/// The case's probes. Throws InputError, which names the probe, for a place where it cannot measure. Names and keys
/// have been checked when the case was read.
template <int Dim>
std::vector<Probe<Dim>> make_probes(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// The progress of a probe.
struct ProbeMark {
  std::size_t taken = 0;  ///< intervals or times that have passed
  std::int64_t size = 0;  ///< bytes of its file; on the root
};

template <int Dim>
class ProbeSet {
 public:
  /// Starts one file per probe, probes/NAME.csv, on the root; or continues those of an earlier run at its marks. Throws
  /// IoError, on all ranks.
  ProbeSet(std::vector<Probe<Dim>> probes, const RunFolder& folder, const Communicator& ranks = {},
           const std::optional<std::vector<ProbeMark>>& marks = {});

  /// The mark of each probe.
  std::vector<ProbeMark> marks() const;

  /// The states of all probes, one after the other; that of the root counts.
  std::vector<double> memory() const;
  /// Restores the states. Throws IoError, which names the folder of the newest checkpoint, if they are not of these
  /// probes.
  void restore(std::span<const double> memory, const std::filesystem::path& checkpoints);

  /// The totals of a probe, by the headings that its type declares.
  struct Summary {
    std::string probe;
    std::vector<std::pair<std::string, double>> lines;
  };
  std::vector<Summary> summaries() const;

  /// Writes the maps of all probes that have one, at `time` [s]. Collective; throws IoError, on all ranks.
  void write_maps(const RunFolder& folder, double time, const Communicator& ranks) const;

  /// Whether any probe is to be read at `time` [s].
  bool is_due(double time) const;

  /// Reads all probes that are due, and appends to their files. Collective; throws IoError, on all ranks.
  void record(const ProbeContext<Dim>& context);

 private:
  struct Instrument {
    Probe<Dim> probe;
    std::optional<CsvWriter> csv;  ///< on the root
    std::size_t taken = 0;         ///< intervals or times that have passed

    bool is_due(double time) const;
    bool is_read(double time) const { return probe.reading.adds_up || is_due(time); }
    void write(double time, const std::vector<Row>& rows);
    void count_as_taken(double time);
  };

  std::vector<Instrument> instruments_;
};

}  // namespace tailwater
