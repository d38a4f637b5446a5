// Rules for the series that prescribe the motion of walls, once the end of the run is known.
#include <fmt/format.h>

#include <string_view>

#include "case/across_tables.h"

namespace tailwater {
namespace {

/// Keys of a table with the name of a series' file and its checksum.
struct SeriesKeys {
  std::string_view file;
  std::string_view checksum;
};

/// Checks that a series of this table lasts to the end of the run; `start` [s] is the time of the run at which it
/// begins. A table with a checksum, such as that of a run that is resumed, keeps its file.
void check_end_of_series(const TimeSeries& series, double start, double end, const CaseLabel& owner,
                         const SeriesKeys& keys, const toml::node_view<const toml::node>& table, Problems& problems) {
  const double last = series.empty() ? end : start + series.time.back();
  const toml::node* node = table[keys.file].node();
  if (node == nullptr || last >= end) return;
  const CaseLabel label = owner.with_key(keys.file);
  if (table[keys.checksum]) {
    problems.wrong(
        "series-of-run-too-short", label, *node,
        fmt::format("{}:{}: its last line is that of t = {:.9g} s, and the run ends at {:.9g} s; end the run "
                    "before, or start another run with a longer file",
                    series.file, series.line.back(), last, end));
    return;
  }
  problems.wrong(
      "series-ends-before-run", label, *node,
      fmt::format("{}:{}: its last line is that of t = {:.9g} s, and the run ends at {:.9g} s; add lines (the "
                  "last values again, if it then rests), or end the run before",
                  series.file, series.line.back(), last, end));
}

}  // namespace

void check_ends_of_series(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  for (std::size_t k = 0; k < spec.walls.size(); ++k) {
    check_end_of_series(spec.walls[k].series, 0.0, spec.time.end, CaseLabel("wall", k), {"motion", "motion_checksum"},
                        root["wall"][k], problems);
  }
  for (std::size_t k = 0; k < spec.gates.size(); ++k) {
    check_end_of_series(spec.gates[k].series, spec.gates[k].start, spec.time.end, CaseLabel("gate", k),
                        {"file", "checksum"}, root["gate"][k], problems);
  }
}

}  // namespace tailwater
