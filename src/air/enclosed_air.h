// Air that water and walls enclose, as a part of a flow (docs/theory/air.md). It searches for pockets every few steps,
// and their pressures are solved for together with that of the water (pocket_pressure.h).
#pragma once

#include <functional>
#include <vector>

#include "air/air_watch.h"
#include "flow/flow.h"
#include "flow/part.h"

namespace tailwater {

/// The place where a vent is drawn, and the wall with which it moves.
template <int Dim>
struct VentPlace {
  Vec<Dim> at;    ///< m
  int wall = -1;  ///< index into Boundary::walls of one within dx/2; -1: there is none
};

/// Totals of all pockets.
struct AirMeasures {
  std::size_t pockets = 0;
  double volume = 0.0;    ///< m^Dim; sum
  double gas = 0.0;       ///< m^Dim; sum, at the pressure of the atmosphere
  double pressure = 0.0;  ///< Pa; pressure of the largest, above the atmosphere's
  double energy = 0.0;    ///< J; energy of all the gas (air/gas_law.h)
};

template <int Dim>
class EnclosedAir final : public Part<Dim> {
 public:
  EnclosedAir() = default;  ///< no air
  /// Throws InputError for a space that is too large to be searched for air.
  EnclosedAir(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary);

  AirState state;
  AirWatch<Dim> watch;
  PocketStep<Dim> step;  ///< the pockets in the present step

  /// Pa; pressure of the gas in a pocket, above the atmosphere's.
  double pressure_of(const AirPocket& pocket) const { return watch.law().pressure(pocket.gas, pocket.volume); }
  /// The pressure [Pa] of the air at a place, above the atmosphere's; empty without pockets. Borrows this and
  /// the boundary.
  std::function<double(const Vec<Dim>&)> pressure_field(const Boundary<Dim>& boundary) const;
  AirMeasures measures() const;

  std::string_view name() const override { return "air"; }
  void begin(Flow<Dim>& flow) override;
  Json save() const override;
  bool restore(const Json& saved) override;
  void reordered(Reordering how) override;
  void begin_step(Flow<Dim>& flow, double dt) override;
  int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) override;
  void add_allowed_tension(const Flow<Dim>& flow, std::vector<double>& tension) const override;
  void finish_solve(Flow<Dim>& flow, double dt) override;
  bool add_pressure(std::span<double> pressure) const override;
  void subtract_pressure(std::span<double> pressure) const override;
  void stay(Flow<Dim>& flow) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void subtract_from_walls(const Flow<Dim>& flow, std::vector<double>& pressure) const override;
  void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const override;
  std::vector<StepColumn> step_columns() const override;
  void add_to_summary(const Flow<Dim>& flow, Json& summary) const override;

 private:
  std::vector<Vec<Dim>> places_of_vents(const Flow<Dim>& flow) const;
  void count_displacement(const Flow<Dim>& flow, double dt);

  std::vector<VentPlace<Dim>> vents_;
  bool starts_at_pressure_ = false;  ///< whether the case gives the pressure of a pocket at the start
};

template <int Dim>
const EnclosedAir<Dim>& air_of(const Flow<Dim>& flow) {
  return flow.template part<EnclosedAir<Dim>>();
}
template <int Dim>
EnclosedAir<Dim>& air_of(Flow<Dim>& flow) {
  return flow.template part<EnclosedAir<Dim>>();
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_enclosed_air(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary);

}  // namespace tailwater
