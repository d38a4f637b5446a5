#include "case/formulation.h"

namespace tailwater {
namespace {

constexpr std::string_view not_exact =
    "its viscous and pressure forces on the water have no equal and opposite force on the wall";
constexpr std::string_view not_one_projection =
    "the force on a body must be the reaction of that on the water, and move both by their new velocities";
constexpr std::string_view has_marked_surface =
    "its pressure is 0 at marked particles of the surface, and no air acts on them";

bool is_published(const SchemeTable& scheme) { return scheme.formulation == Formulation::published; }

/// Zones of refinement have been derived and tested for the default choices only.
std::string_view excludes_zones(const SchemeTable& scheme) {
  if (is_published(scheme)) return "scheme.formulation = \"published\"";
  if (scheme.name == SchemeName::farmani2020) return "scheme.name = \"farmani2020\"";
  return scheme.pair_vectors == PairVectors::corrected ? "" : "scheme.pair_vectors other than \"corrected\"";
}

}  // namespace

FormulationTraits traits_of(const CaseSpec& spec) {
  const bool is_two_step = spec.scheme.name == SchemeName::farmani2020;
  const std::string_view no_zones = excludes_zones(spec.scheme);
  if (!is_published(spec.scheme)) {
    const bool moves_with_mean = is_two_step || spec.study.displacement == Displacement::mean_velocity;
    return {spec.study.support,
            {.on_wall = false, .behind = true},
            "",
            moves_with_mean ? not_one_projection : "",
            "",
            no_zones};
  }
  if (is_two_step)
    return {2.4, {.on_wall = true, .behind = true}, "", not_one_projection, has_marked_surface, no_zones};
  return {3.0, {.on_wall = true, .behind = false}, not_exact, not_one_projection, has_marked_surface, no_zones};
}

double age_of_forces(const CaseSpec& spec) {
  return spec.scheme.integrator == Integrator::implicit_projection ? 0.5 : 1.0;
}

void apply_formulation(SchemeTable& scheme) {
  const bool is_explicit = scheme.integrator == Integrator::explicit_projection;
  switch (scheme.name) {
    case SchemeName::farzin2014:
      if (is_published(scheme)) scheme.courant = is_explicit ? 0.05 : 0.12;
      return;
    case SchemeName::farmani2020:
      // The value of the robust formulation keeps its loss of energy small, which grows with the step.
      scheme.courant = is_published(scheme) ? 0.1 : 0.25;
      return;
  }
}

}  // namespace tailwater
