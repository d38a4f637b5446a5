// Zones that relax the water's velocity to rest, to a current or to that of waves: a body force (docs/theory/waves.md).
#pragma once

#include <vector>

#include "flow/part.h"
#include "motion/wave_zone.h"

namespace tailwater {

template <int Dim>
class DampingZones final : public Part<Dim> {
 public:
  DampingZones() = default;
  explicit DampingZones(std::vector<WaveZone<Dim>> zones) : zones_(std::move(zones)) {}

  std::string_view name() const override { return "damping_zones"; }
  void add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<double>& rate) const override;
  void add_relaxation(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<Vec<Dim>>& drive) const override;

 private:
  std::vector<WaveZone<Dim>> zones_;
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_damping_zones(const CaseSpec& spec, const Setup<Dim>& setup,
                                              const Boundary<Dim>& boundary);

}  // namespace tailwater
