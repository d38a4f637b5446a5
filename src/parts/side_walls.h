// The friction of the two side walls of a channel of width b, in 2D, where it acts on all the water:
//
//   a = -2 tau(|u|)/(rho b) u/|u|
#pragma once

#include <vector>

#include "flow/part.h"

namespace tailwater {

struct SideWallLaw {
  double viscosity = 0.0;  ///< m^2/s; molecular
  double width = 0.0;      ///< m; b
  double roughness = 0.0;  ///< m; k_s of both walls

  /// Rate [1/s] at which the walls slow water of this speed, averaged over the width: 2 tau/(rho b u). tau/rho is the
  /// larger of two values: 6 nu u/b, laminar flow between plates, and u_tau^2 of the turbulent wall law, whose mean
  /// over 0 .. b/2 is the speed.
  double rate(double speed) const;
};

template <int Dim>
class SideWalls final : public Part<Dim> {
 public:
  SideWalls() = default;
  explicit SideWalls(const SideWallLaw& law) : law_(law) {}

  const SideWallLaw& law() const { return law_; }

  std::string_view name() const override { return "side_walls"; }
  void add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<double>& rate) const override;

 private:
  SideWallLaw law_;
};

/// Throws InputError where the walls are so close to each other that their friction stops the water within a step.
template <int Dim>
std::unique_ptr<Part<Dim>> make_side_walls(const CaseSpec& spec, const Setup<Dim>& setup,
                                           const Boundary<Dim>& boundary);

}  // namespace tailwater
