// steps.csv: one line per time step.
#pragma once

#include <filesystem>

#include "io/csv_writer.h"
#include "schemes/flow.h"

namespace tailwater {

class StepLog {
 public:
  explicit StepLog(const std::filesystem::path& path);
  void write(double time, std::int64_t step, const StepReport& report, const FlowMeasures& measures);

 private:
  CsvWriter csv_;
};

}  // namespace tailwater
