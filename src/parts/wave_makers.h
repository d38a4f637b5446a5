// Wave makers that absorb waves: the speed of each plate in a step, by which it absorbs waves that are not its own. It
// is the difference between the elevation in front of the plate and the elevation of its own waves, times a gain
// (docs/theory/waves.md). The plates' own motion is that of walls (motion/wave_maker.h), and the displacement by
// absorption is part of its state.
#pragma once

#include <vector>

#include "flow/part.h"
#include "motion/wave_maker.h"

namespace tailwater {

template <int Dim>
class WaveMakers final : public Part<Dim> {
 public:
  WaveMakers() = default;
  explicit WaveMakers(std::vector<WavePlate<Dim>> plates) : plates_(std::move(plates)) {}

  std::string_view name() const override { return "wave_makers"; }
  void begin_step(Flow<Dim>& flow, double dt) override;

 private:
  std::vector<WavePlate<Dim>> plates_;  ///< one per wave maker
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_wave_makers(const CaseSpec& spec, const Setup<Dim>& setup,
                                            const Boundary<Dim>& boundary);

}  // namespace tailwater
