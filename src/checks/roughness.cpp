#include "checks/checks.h"

namespace tailwater {

template <int Dim>
Findings check_roughness(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  Findings findings;
  for (std::size_t w = 0; w < boundary.walls.size(); ++w) {
    const double roughness = boundary.walls[w].roughness;
    if (boundary.walls[w].friction == 0.0 || roughness <= dx) continue;
    const double manning = spec.walls[w].manning;
    const std::string source =
        manning > 0.0 ? fmt::format(", which is that of manning = {:.6g} s/m^(1/3),", manning) : "";
    findings.push_back(
        Finding::warning({"{}: its roughness k_s = {:.3g}{} is larger than the spacing, {:.3g} m, and the law of rough "
                          "walls does not hold "
                          "for particles between its grains",
                          wall_label(boundary, static_cast<int>(w)), Amount{roughness, "m"}, source, dx},
                         {"draw what sticks out of the wall and give a smaller roughness, or a larger spacing"}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_roughness);

}  // namespace tailwater
