// The velocity of the buffer of an open end without a prescribed discharge, from the water before it, fibre by fibre.
#pragma once

#include "open_ends/open_end.h"

namespace tailwater {

template <int Dim>
struct Flow;

/// Water that comes in with a free surface from a level beyond.
struct Inflow {
  double depth = 0.0;   ///< m
  double speed = 0.0;   ///< m/s; mean, into the case
  double froude = 0.0;  ///< Froude number; 0 where water leaves
};

/// The inflow from water at rest that stands `head` [m] above the bed, where the characteristic that leaves the case
/// has u - 2c = `invariant` [m/s] (u into the case): the subcritical root of h + u^2/2g = head, at most critical flow;
/// where the characteristic carries water out, the head itself. docs/theory/open_ends.md.
Inflow inflow_of_head(double gravity, double head, double invariant);

/// Sets `fibre_speeds` and `stretching`. Along each fibre a line is fitted to the velocity of the water in the three
/// spacings before the buffer and continued to its border. The mean below `state.depth` is led towards the speed of
/// `inflow` by the square of its Froude number: critical inflow takes nothing from inside. Collective.
template <int Dim>
void find_fibres(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Inflow& inflow, OpenEndState& state);

}  // namespace tailwater
