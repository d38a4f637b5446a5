#include "checks/check.h"

#include <set>
#include <string>
#include <vector>

#include "checks/checks.h"

namespace tailwater {

template <int Dim>
Findings check_geometry(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Findings findings;
  append(findings, check_units<Dim>(spec));
  append(findings, check_blocks(spec, fluid));
  append(findings, check_periodic_width(spec, boundary));
  if constexpr (Dim == 2) {
    append(findings, check_self_crossing(spec, boundary));
    append(findings, check_crests(spec, boundary));
  } else {
    append(findings, check_meshes(spec, boundary, fluid));
  }
  append(findings, check_wall_thickness(spec, boundary, fluid));
  append(findings, check_plates(spec, boundary));
  append(findings, check_roughness(spec, boundary, fluid));
  append(findings, check_overlap(spec, boundary, fluid));
  append(findings, check_fluid_at_walls(spec, boundary, fluid));
  append(findings, check_open_ends(spec, boundary, fluid));
  const Findings flows = check_end_flows(spec, boundary, fluid);
  append(findings, flows);
  if (!has_error(findings)) append(findings, check_closed_space(spec, boundary, fluid));
  append(findings, check_wave_makers(spec, fluid));
  if (!has_error(flows)) append(findings, check_speeds<Dim>(spec));
  append(findings, check_creep(spec, fluid));
  append(findings, check_late_starts(spec));
  append(findings, check_bodies(spec, boundary));
  append(findings, check_body_gaps(spec, boundary));
  append(findings, check_moorings(spec, boundary));
  append(findings, check_springs(spec, fluid));
  append(findings, check_refinement(spec, boundary, fluid));
  append(findings, check_air_places(spec, boundary));
  append(findings, check_leaks(spec, boundary, fluid));
  if (!has_error(findings)) append(findings, check_hanging_water(spec, boundary, fluid));
  if (!has_error(findings)) append(findings, check_sealed_space(spec, boundary, fluid));
  append(findings, check_moving_walls(spec, boundary, fluid));
  if (!has_error(findings)) {
    append(findings, check_closed_gaps(spec, boundary));
    append(findings, check_damping(spec, boundary, fluid));
    append(findings, check_wave_zones(spec, fluid));
    append(findings, check_probes(spec, boundary, fluid));
    append(findings, check_shared_force(spec, boundary));
  }
  // Several faces may have the same finding, as the two of a plate.
  std::set<std::string> reported;
  std::erase_if(findings, [&](const Finding& finding) { return !reported.insert(finding.problem).second; });
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_geometry);

}  // namespace tailwater
