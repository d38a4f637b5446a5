// The results of the probes of a run, in a few numbers and in words: "upstream: 0.2890 m (mean of the second half)".
// They are made from the tables of the probes, so a resumed run reports the same results as one that was never stopped.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "case/spec.h"
#include "io/run_folder.h"

namespace tailwater {

struct Quantity {
  std::string name;   ///< "depth", "force x"
  std::string label;  ///< text before the number in words; empty for the main quantity of the probe
  double value = 0.0;
  std::optional<double> to = {};  ///< the upper end, if it is a range
  std::string unit;
  std::string what;  ///< "mean of the second half"
};

struct ProbeResult {
  std::string probe;
  std::string type;
  std::vector<Quantity> quantities;

  /// "0.2890 m (mean of the second half), highest 0.3012 m (at 2.1 s)".
  std::string words() const;
};

/// The result of each probe that has taken a reading, in the order of the case, after a run up to `time` [s]. Throws
/// IoError if a table cannot be read. `speed` is that of the case, sqrt(2 g H) [m/s].
std::vector<ProbeResult> probe_results(const CaseSpec& spec, const RunFolder& folder, double time, double speed = 0.0);

/// The block "results" of the summary: by probe its type, quantities and words.
Json json_of(const std::vector<ProbeResult>& results);

}  // namespace tailwater
