// Forces in the next step, in addition to those of the case, from a program that uses this one as a library.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "flow/part.h"
#include "motion/floating_body.h"

namespace tailwater {

/// No case contains these loads: a program gives them to a flow (`script_loads` below). They act for one step. Empty
/// fields add nothing. A step without loads is bit-identical to one without this part.
template <int Dim>
class ScriptLoads final : public Part<Dim> {
 public:
  std::vector<Vec<Dim>> acceleration;  ///< m/s^2; force per mass on each owned particle; acts on water only
  std::vector<Twist<Dim>> on_bodies;   ///< N, N m, in 2D per metre of width; on each body, about its centre of mass

  void clear();
  /// Adds `on_bodies` to the loads of the bodies.
  void add_to_bodies(std::span<Twist<Dim>> loads) const;

  std::string_view name() const override { return "script_loads"; }
  void add_acceleration(const Flow<Dim>& flow, std::span<Vec<Dim>> acceleration_of_water) const override;
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;
};

/// The loads of a flow. Adds this part to a flow that has none.
template <int Dim>
ScriptLoads<Dim>& script_loads(Flow<Dim>& flow);

}  // namespace tailwater
