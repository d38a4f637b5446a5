// steps.csv: one line per time step.
#pragma once

#include <filesystem>

#include "flow/measure.h"
#include "flow/step.h"
#include "io/csv_writer.h"

namespace tailwater {

class StepLog {
 public:
  explicit StepLog(const std::filesystem::path& path);
  void write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures);

 private:
  CsvWriter csv_;
};

}  // namespace tailwater
