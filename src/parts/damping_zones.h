// Zones in which waves decay: a body force against the water's velocity (docs/theory/waves.md).
#pragma once

#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "flow/part.h"

namespace tailwater {

template <int Dim>
class DampingZone {
 public:
  explicit DampingZone(const DampingTable& table);

  /// The rate [1/s] at which water at `x` loses its velocity.
  double rate_at(const Vec<Dim>& x) const;

 private:
  Vec<Dim> low_, high_;
  int axis_;
  bool grows_upwards_;
  double strength_;
};

template <int Dim>
class DampingZones final : public Part<Dim> {
 public:
  DampingZones() = default;
  explicit DampingZones(std::vector<DampingZone<Dim>> zones) : zones_(std::move(zones)) {}

  std::string_view name() const override { return "damping_zones"; }
  void add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<double>& rate) const override;

 private:
  std::vector<DampingZone<Dim>> zones_;
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_damping_zones(const CaseSpec& spec, const Setup<Dim>& setup,
                                              const Boundary<Dim>& boundary);

}  // namespace tailwater
