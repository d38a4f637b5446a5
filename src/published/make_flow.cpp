#include "published/make_flow.h"

#include <array>

#include "air/enclosed_air.h"
#include "air/pulled_walls.h"
#include "air/voids_under_tension.h"
#include "bodies/fixed_hulls.h"
#include "bodies/floating_bodies.h"
#include "open_ends/open_ends.h"
#include "parts/boundary_layers.h"
#include "parts/damping_zones.h"
#include "parts/domain_floor.h"
#include "parts/refinement.h"
#include "parts/rest_watch.h"
#include "parts/section_counters.h"
#include "parts/side_walls.h"
#include "parts/wave_makers.h"
#include "porous/porous_layers.h"
#include "published/farmani2020.h"
#include "published/farzin2014.h"
#include "rheology/thick_liquid.h"
#include "robust/formulation.h"

namespace tailwater {

template <int Dim>
FlowFormulation<Dim> make_formulation(const CaseSpec& spec) {
  const bool is_published = spec.scheme.formulation == Formulation::published;
  if (spec.scheme.name == SchemeName::farmani2020) {
    return is_published ? published_farmani<Dim>(spec) : robust_farmani<Dim>(spec);
  }
  return is_published ? published_farzin<Dim>(spec) : robust_farzin<Dim>(spec);
}

template <int Dim>
Flow<Dim> make_flow(const CaseSpec& spec, const Communicator& ranks) {
  // All parts that a flow can have, in the order in which the stages call them. Porous layers are first: the other
  // parts see the velocity of the water in the pores, with which it moves.
  static constexpr std::array parts{
      make_porous_layers<Dim>, make_open_ends_part<Dim>, make_domain_floor<Dim>,        make_wave_makers<Dim>,
      make_side_walls<Dim>,    make_damping_zones<Dim>,  make_boundary_layers<Dim>,     make_floating_bodies<Dim>,
      make_fixed_hulls<Dim>,   make_enclosed_air<Dim>,   make_voids_under_tension<Dim>, make_section_counters<Dim>,
      make_thick_liquid<Dim>,  make_rest_watch<Dim>,     make_refinement<Dim>,          make_pulled_walls<Dim>,
  };
  return Flow<Dim>(spec, make_formulation<Dim>(spec), parts, ranks);
}

TAILWATER_IN_2D_AND_3D(make_formulation);
TAILWATER_IN_2D_AND_3D(make_flow);

}  // namespace tailwater
