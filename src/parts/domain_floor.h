// Removes water that has fallen below all walls. It cannot return, and in free fall it would shorten the time step of
// all water.
#pragma once

#include "flow/part.h"
#include "flow/water_amount.h"

namespace tailwater {

template <int Dim>
class DomainFloor final : public Part<Dim> {
 public:
  /// Water that has fallen below all walls since the start.
  const WaterAmount& fallen() const { return fallen_; }

  std::string_view name() const override { return "domain_floor"; }
  Json save() const override;
  bool restore(const Json& saved) override;
  void take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves) override;
  void add_passed_water(WaterAmount& departed, WaterAmount& arrived) const override;

 private:
  WaterAmount fallen_;
};

/// Null without gravity.
template <int Dim>
std::unique_ptr<Part<Dim>> make_domain_floor(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary);

}  // namespace tailwater
