// The load balance of a run among its ranks, and their messages: ranks.csv, with one line for each repartition of the
// particles, and a block of summary.json.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "base/json.h"
#include "flow/measure.h"
#include "flow/step.h"
#include "io/csv_writer.h"
#include "neighbours/decomposition.h"

namespace tailwater {

class RankLog {
 public:
  /// Starts the file on the root, or continues after `kept` bytes of an earlier one. Throws IoError, on all ranks.
  RankLog(const Communicator& ranks, const std::filesystem::path& path, std::optional<std::int64_t> kept = {});

  /// Logs the result of a repartition and the traffic since the last call. Collective. Throws IoError, on all ranks.
  template <int Dim>
  void write(const Flow<Dim>& flow, const Repartition& repartition);

  /// Block "ranks" of the summary. Collective; valid on the root.
  Json json() const;

  /// All sums of this rank, for a checkpoint, and from one.
  std::vector<double> saved() const;
  void restore(std::span<const double> saved);

  /// Bytes of the file; 0 where there is none.
  std::int64_t size() const { return csv_ ? csv_->size() : 0; }

 private:
  using Clock = std::chrono::steady_clock;

  template <class Self, class Body>
  static void for_each_sum(Self& self, Traffic& traffic, Body&& body);

  Communicator ranks_;
  std::optional<CsvWriter> csv_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  Traffic at_last_;
  std::int64_t lines_ = 0;
  std::int64_t cuts_ = 0;
  std::int64_t moved_ = 0;
  double ghosts_sum_ = 0.0;  ///< sum over all ranks
  double imbalance_sum_ = 0.0;
  double imbalance_largest_ = 0.0;  ///< without the first line, which is that of the start
};

}  // namespace tailwater
