#include "checks/checks.h"

namespace tailwater {

Findings check_late_starts(const CaseSpec& spec) {
  Findings findings;
  const auto check = [&](const CaseLabel& owner, double start) {
    if (start < spec.time.end) return;
    findings.push_back(Finding::warning("motion-after-end",
                                        {"{} begins to move at {:.6g}, but the run ends at {:.6g} s: it never moves",
                                         owner, Amount{start, "s"}, spec.time.end},
                                        {"end the run later, or give an earlier start"}));
  };
  for (const GateTable& gate : spec.gates) check(CaseLabel("gate", gate.name), gate.start);
  for (const WaveMakerTable& maker : spec.wave_makers) {
    if (maker.waves != WaveKind::none) check(CaseLabel("wave_maker", maker.name), maker.start);
  }
  for (const DampingTable& zone : spec.damping) {
    if (zone.waves != WaveKind::none) check(CaseLabel("damping", zone.name), zone.start);
  }
  for (const MeasurementTable& measurement : spec.measurements) {
    const TimeSeries& series = measurement.series;
    if (series.empty() || series.time.front() - measurement.shift <= spec.time.end) continue;
    findings.push_back(
        Finding::warning("measurement-after-end",
                         {"{}: {} begins at {:.6g}, but the run ends at {:.6g} s: probe '{}' is compared with nothing",
                          CaseLabel("measurement", measurement.name), measurement.file,
                          Amount{series.time.front(), "s"}, spec.time.end, measurement.probe},
                         {"end the run later, or shift the times of the file so that t = 0 is the start of the run"}));
  }
  return findings;
}

}  // namespace tailwater
