// The four formulations of the case file: farzin2014 and farmani2020, each robust or as published.
// robust/formulation.cpp and published/ make them; this file has the properties that are needed before there is a flow.
#pragma once

#include <string_view>

#include "case/spec.h"

namespace tailwater {

/// The places of wall particles. If some stand on the wall, the water's lattice has nodes there too.
struct WallPlacement {
  bool on_wall;
  bool behind;
};

struct FormulationTraits {
  double support;                ///< dx; radius of the kernel's support
  WallPlacement walls;           ///< places of wall particles
  std::string_view no_reaction;  ///< why forces on walls cannot be measured; empty if they can
  std::string_view no_floating;  ///< why bodies cannot float; empty if they can
  std::string_view no_pockets;   ///< why enclosed air cannot be a gas; empty if it can
  std::string_view no_zones;     ///< the choice that excludes zones of refinement; empty if they can be used
};

FormulationTraits traits_of(const CaseSpec& spec);

/// Time from the instant when forces on walls act to the end of the step, over its length. The pressure of the explicit
/// step acts where the step begins, that of two projections in about equal parts where it begins and where it ends.
double age_of_forces(const CaseSpec& spec);

/// Sets the keys whose default depends on `name`, `formulation` and `integrator`: the Courant number, which is that of
/// the papers where published. Call it on the initialisers, before the keys given in the file are read.
void apply_formulation(SchemeTable& scheme);

}  // namespace tailwater
