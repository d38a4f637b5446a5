// The liquid beyond an open end at each height, in a case with several liquids. It is the liquid that the buffer has at
// this height at the start, from the block that the case draws before the opening. This liquid enters during the whole
// run, whatever liquids are inside.
#pragma once

#include <span>
#include <vector>

#include "flow/flow.h"
#include "open_ends/open_end.h"

namespace tailwater {

class LiquidsBeyond {
 public:
  /// For a case of one liquid.
  LiquidsBeyond() = default;
  /// Reads the particles in the buffer of an end. Collective.
  template <int Dim>
  LiquidsBeyond(const OpenEnd<Dim>& end, const Flow<Dim>& flow);

  /// The liquid at a height [m] above the floor of the opening.
  int at(double height) const;
  /// kg/m^3; mean between two heights [m]; `density` is that of each liquid.
  double mean_density(double low, double high, std::span<const double> density) const;

 private:
  double step_ = 1.0;        ///< m
  std::vector<int> liquid_;  ///< of each step from the floor upwards; the last one goes on above the opening
};

/// kg/m^3; mean of the liquids above a place in the buffer of an end.
template <int Dim>
double density_above(const Flow<Dim>& flow, const OpenEnd<Dim>& end, const OpenEndState& state,
                     const LiquidsBeyond& liquids, const Vec<Dim>& x);

}  // namespace tailwater
