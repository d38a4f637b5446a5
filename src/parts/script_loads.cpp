#include "parts/script_loads.h"

#include "base/for_each.h"
#include "flow/flow.h"

namespace tailwater {

template <int Dim>
void ScriptLoads<Dim>::clear() {
  acceleration.clear();
  on_bodies.clear();
}

template <int Dim>
void ScriptLoads<Dim>::add_to_bodies(std::span<Twist<Dim>> loads) const {
  for (std::size_t b = 0; b < on_bodies.size(); ++b) loads[b] += on_bodies[b];
}

/// Walls that were gathered after the loads were given stand behind all others, and have no loads.
template <int Dim>
void ScriptLoads<Dim>::add_acceleration(const Flow<Dim>& /*flow*/, std::span<Vec<Dim>> acceleration_of_water) const {
  for_each(acceleration.size(), [&](std::size_t i) { acceleration_of_water[i] += acceleration[i]; });
}

template <int Dim>
void ScriptLoads<Dim>::finish_step(Flow<Dim>& /*flow*/, const StepStart<Dim>& /*start*/, double /*dt*/) {
  clear();
}

template <int Dim>
ScriptLoads<Dim>& script_loads(Flow<Dim>& flow) {
  for (const auto& part : flow.parts) {
    if (auto* const loads = dynamic_cast<ScriptLoads<Dim>*>(part.get())) return *loads;
  }
  auto loads = std::make_unique<ScriptLoads<Dim>>();
  ScriptLoads<Dim>& added = *loads;
  flow.parts.push_back(std::move(loads));
  return added;
}

template class ScriptLoads<2>;
template class ScriptLoads<3>;
TAILWATER_IN_2D_AND_3D(script_loads);

}  // namespace tailwater
