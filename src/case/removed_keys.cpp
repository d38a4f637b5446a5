#include "case/removed_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tailwater {
namespace {

constexpr std::string_view part =
    "was removed: it is a part of the formulation; scheme.name and scheme.formulation choose among the four there are";
constexpr std::string_view pulled =
    "was removed: a weight m over a pulley lifts a gate of mass M with motion = \"acceleration\" and acceleration = "
    "\"g*(m - M)/(m + M)\"";
constexpr std::string_view in_study = "was moved to the table [study], under the same name";

/// Keys of tables that a case may have several times. No rule can migrate them.
constexpr std::array removed_of_lists{
    RemovedKey{"gate", "direction",
               "was removed: a gate is pulled up, against gravity; one that moves otherwise is a [[wall]] with shape = "
               "\"plate\" and a displacement"},
    RemovedKey{"gate", "weight", pulled},
    RemovedKey{"gate", "gate_mass", pulled},
    RemovedKey{"wave_maker", "components", "was removed: irregular waves have 200 components"},
    RemovedKey{"wave_maker", "order", "was removed: plates make waves of second order, without free waves beside them"},
    RemovedKey{"mooring", "name", "was removed: messages call the lines mooring1, mooring2, ..."},
    RemovedKey{"damping", "name", "was removed: messages call the zones damping1, damping2, ..."},
    RemovedKey{"probe", "region_points",
               "was removed: a region is a box, region_min to region_max; for another part of a wall draw that part as "
               "a wall with a name, and give it in `walls`"},
};

constexpr std::array removed{
    RemovedKey{"scheme", "kernel", part},
    RemovedKey{"scheme", "laplacian", part},
    RemovedKey{"scheme", "gradient", part},
    RemovedKey{"scheme", "divergence", part},
    RemovedKey{"scheme", "source", part},
    RemovedKey{"scheme", "surface", part},
    RemovedKey{"scheme", "surface_density", part},
    RemovedKey{"scheme", "walls", part},
    RemovedKey{"scheme", "viscosity_floor", part},
    RemovedKey{"scheme", "smagorinsky", part},
    RemovedKey{"scheme", "shifting_cap", part},
    RemovedKey{"scheme", "implicit_form", part},
    RemovedKey{"scheme", "max_passes", part},
    RemovedKey{"scheme", "pass_tolerance", part},
    RemovedKey{"scheme", "relax_pressure", part},
    RemovedKey{"scheme", "relax_velocity", part},
    RemovedKey{"scheme", "relax_position", part},
    RemovedKey{"scheme", "support", in_study, "support"},
    RemovedKey{"scheme", "length", in_study, "length"},
    RemovedKey{"scheme", "artificial_viscosity", in_study, "artificial_viscosity"},
    RemovedKey{"scheme", "noise_viscosity", in_study, "noise_viscosity"},
    RemovedKey{"scheme", "density_relaxation", in_study, "density_relaxation"},
    RemovedKey{"scheme", "energy_slack", in_study, "energy_slack"},
    RemovedKey{"scheme", "divergence_free", in_study, "divergence_free"},
    RemovedKey{"scheme", "displacement", in_study, "displacement"},
    RemovedKey{"scheme", "shifting", "was replaced by study.shifting, the strength of the shifting; 0: none",
               "shifting"},
    RemovedKey{"scheme", "shifting_strength", "was replaced by study.shifting", "shifting"},
    RemovedKey{
        "pressure_solver", "method",
        "was removed: the method goes with the preconditioner; -pressure_ksp_type in petsc_options names another"},
    RemovedKey{"parallel", "decomposition", "was removed: space is cut by recursive coordinate bisection"},
    RemovedKey{"limits", "smallest_step", "was removed: a step may shrink to a thousandth of the first"},
    RemovedKey{"output", "compression", "was removed: field files have the quickest compression"},
};

}  // namespace

std::span<const RemovedKey> removed_keys() { return removed; }

std::string fate_of(std::string_view table, std::string_view key) {
  const auto is_it = [&](const RemovedKey& entry) { return entry.table == table && entry.key == key; };
  if (const auto found = std::ranges::find_if(removed, is_it); found != removed.end()) {
    return fmt::format("{}; `tailwater migrate` brings the file up to date", found->fate);
  }
  const auto found = std::ranges::find_if(removed_of_lists, is_it);
  return found == removed_of_lists.end() ? "" : std::string(found->fate);
}

}  // namespace tailwater
