// steps.csv: one line per time step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "flow/measure.h"
#include "flow/step.h"
#include "io/csv_writer.h"

namespace tailwater {

class StepLog {
 public:
  /// Has columns for the measures' `of_parts`. `kept`: bytes of the file of an earlier run that this run continues
  /// (io/csv_writer.h).
  explicit StepLog(const std::filesystem::path& path, const FlowMeasures& measures,
                   std::optional<std::int64_t> kept = {});
  void write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures);
  const CsvWriter& csv() const { return csv_; }

 private:
  CsvWriter csv_;
};

}  // namespace tailwater
