// Inlets and outlets as a part of the flow: docs/theory/open_ends.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/box.h"
#include "flow/part.h"
#include "open_ends/fibres.h"
#include "open_ends/liquids_beyond.h"
#include "open_ends/open_end.h"

namespace tailwater {

template <int Dim>
class OpenEnds final : public Part<Dim> {
 public:
  OpenEnds() = default;
  explicit OpenEnds(std::vector<OpenEnd<Dim>> ends)
      : ends_(std::move(ends)), states_(ends_.size()), inflows_(ends_.size()) {}

  /// One per inlet, then one per outlet.
  const std::vector<OpenEnd<Dim>>& ends() const { return ends_; }
  /// The state of each.
  const std::vector<OpenEndState>& states() const { return states_; }
  /// Whether water at `x` has left through one of them.
  bool is_passed_by(const Vec<Dim>& x) const;
  /// The water that left through all of them since the start, and that came.
  WaterAmount departed() const;
  WaterAmount arrived() const;
  /// The water that waits to enter through the ends of a circuit (ChannelEnd::circuit): its reserve and what has left
  /// through them, less what came. `density` [kg/m^3] is that of its liquid. Energy is not counted.
  WaterAmount sump(int circuit, double density) const;
  /// The water that has passed each inlet, or each outlet, for the summary; `density` [kg/m^3] is that of a circuit.
  Json balance(OpeningKind kind, double density) const;
  /// From `time` [s] on the inlet brings the discharge [m^3/s]. Throws InputError if there is no inlet of that name or
  /// the case gives it no discharge.
  void set_discharge(const std::string& inlet, double time, double discharge);

  std::string_view name() const override { return "open_ends"; }
  bool is_open() const override { return true; }
  void extend_box(Box<Dim>& box) const override;
  void begin(Flow<Dim>& flow) override;
  Json save() const override;
  bool restore(const Json& saved) override;
  void take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves) override;
  bool bring_in(Flow<Dim>& flow) override;
  StepLimits step_limits(const Flow<Dim>& flow) const override;
  void claim(const Flow<Dim>& flow, std::span<Role> role) override;
  void begin_step(Flow<Dim>& flow, double dt) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void write_rows(Flow<Dim>& flow) override;
  void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const override;
  void add_passed_water(WaterAmount& departed, WaterAmount& arrived) const override;
  /// Warns of levels that are not held (LevelError) and of inlets that pass more or less than prescribed.
  void warn(const Flow<Dim>& flow) override;
  /// Warns again of levels that were not held: for how long, and whether they are now.
  void warn_at_end(const Flow<Dim>& flow) const override;

 private:
  /// Whether something is prescribed where owned particle i is in this step.
  bool is_driven(std::size_t i) const { return end_of_[i] >= 0 && ends_[end_of_[i]].is_driven(); }
  /// Gives the water in the buffer of end e its velocity.
  void set_velocities(Flow<Dim>& flow, std::size_t e) const;
  /// J; of this rank's water where something is prescribed.
  double kinetic_energy_in_driven_ends(const Flow<Dim>& flow) const;
  void write_row(Flow<Dim>& flow, std::size_t i) const;
  double work_of_driven_particle(const Flow<Dim>& flow, std::size_t i, double dt) const;
  /// Whether this is the first warning of its kind; it is not from now on.
  bool is_first(const std::string& warning);

  std::vector<OpenEnd<Dim>> ends_;
  std::vector<LiquidsBeyond> liquids_;  ///< of each end
  // Saved in checkpoints.
  std::vector<OpenEndState> states_;
  std::vector<std::string> warnings_;  ///< kinds of those that were given
  // In one step.
  std::vector<std::int16_t> end_of_;  ///< the end whose buffer holds each owned particle, or -1
  std::vector<Inflow> inflows_;       ///< of each end
  double driven_change_ = 0.0;        ///< J; change of this rank's kinetic energy by the prescribed velocities
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_open_ends_part(const CaseSpec& spec, const Setup<Dim>& setup,
                                               const Boundary<Dim>& boundary);

}  // namespace tailwater
