#include "results/air_balance.h"

#include <nlohmann/json.hpp>

#include "flow/air_pressure.h"
#include "flow/measure.h"

namespace tailwater {

template <int Dim>
Json pockets_of(const Flow<Dim>& flow) {
  const AirState& air = flow.state.air;
  Json now = Json::array();
  for (const AirPocket& pocket : air.pockets) {
    now.push_back({{"number", pocket.number},
                   {"volume_m3", pocket.volume},
                   {"gas_m3", pocket.gas},
                   {"pressure_Pa", pressure_of(flow, pocket)}});
  }
  return {{"begun", air.begun},
          {"ended", air.ended},
          {"gas_found_m3", air.gas_found},
          {"gas_lost_m3", air.gas_lost},
          {"gas_vented_m3", air.gas_vented},
          {"energy_J", measure_air(flow).energy},
          {"energy_lost_J", air.energy_lost},
          {"energy_vented_J", air.energy_vented},
          {"energy_set_J", air.energy_set},
          {"now", std::move(now)}};
}

template <int Dim>
PocketTotals pocket_totals(const Flow<Dim>& flow) {
  const AirMeasures air = measure_air(flow);
  return {.pressure = air.pressure,
          .volume = air.volume,
          .gas = air.gas,
          .vented = flow.state.air.gas_vented,
          .energy = air.energy,
          .pockets = static_cast<double>(air.pockets)};
}

TAILWATER_IN_2D_AND_3D(pockets_of);
TAILWATER_IN_2D_AND_3D(pocket_totals);

}  // namespace tailwater
