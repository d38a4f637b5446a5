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
  return findings;
}

}  // namespace tailwater
