// Voids in water under tension, as a part of a flow. Where walls hold the water (physics.tension) it may separate in a
// place that no air can reach, as behind the sharp edge of a siphon's crown. The run counts each void as air at the
// pressure of the atmosphere, so such a void grows until the siphon is dry. The part follows the gas that voids
// enclosed when they began, and warns where a void has grown by more than half of its gas. It does not change the flow.
// Where enclosed air is a gas, its pressure resists the growth, and the case needs no such part.
//
// A run that is resumed takes the voids of that time as enclosed air.
#pragma once

#include "air/air_watch.h"
#include "flow/flow.h"
#include "flow/part.h"

namespace tailwater {

template <int Dim>
class VoidsUnderTension final : public Part<Dim> {
 public:
  /// Throws InputError for a space that is too large to be searched.
  VoidsUnderTension(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary);

  /// The void that has grown, or null. Valid until the next step.
  const AirPocket* find_grown() const;

  std::string_view name() const override { return "voids_under_tension"; }
  void begin_step(Flow<Dim>& flow, double dt) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void warn(const Flow<Dim>& flow) override;

 private:
  double volume_of(const AirPocket& pocket) const;

  double spacing_;
  AirWatch<Dim> watch_;
  AirState voids_;
  bool is_told_ = false;
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_voids_under_tension(const CaseSpec& spec, const Setup<Dim>& setup,
                                                    const Boundary<Dim>& boundary);

}  // namespace tailwater
