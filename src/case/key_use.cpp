#include "case/key_use.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/assert.h"

namespace tailwater {

namespace {

bool contains(const std::vector<std::string_view>& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Keys of wave makers and zones.
std::vector<KeyUse> uses_of_waves() {
  return {
      {"wave_maker", "waves", "regular", {"height", "period"}, {"ramp"}},
      {"wave_maker", "waves", "solitary", {"height"}, {}},
      {"wave_maker", "waves", "n-wave", {"height"}, {}},
      {"wave_maker", "waves", "jonswap", {"height", "period"}, {"peak_enhancement", "seed", "ramp"}},
      {"wave_maker", "waves", "focused", {"height", "period", "focus"}, {"peak_enhancement", "seed", "ramp"}},
      {"wave_maker", "waves", "none", {}, {"period"}},
      {"damping",
       "waves",
       "regular",
       {"height", "period", "depth", "level"},
       {"ramp", "start", "transport", "direction"}},
      {"damping",
       "waves",
       "jonswap",
       {"height", "period", "depth", "level"},
       {"peak_enhancement", "seed", "ramp", "start", "transport", "direction", "spreading"}},
      {"damping",
       "waves",
       "focused",
       {"height", "period", "depth", "level", "focus"},
       {"peak_enhancement", "seed", "ramp", "start", "transport", "direction", "spreading"}},
      {"damping", "waves", "none", {}, {"period", "depth", "transport"}},
  };
}

/// Keys of all other tables.
std::vector<KeyUse> uses_of_shapes_and_types() {
  return {
      {"fluid", "shape", "box", {"min", "max"}, {}},
      {"fluid", "shape", "polygon", {"points"}, {}},
      {"fluid", "shape", "fill", {"seed", "level"}, {}},
      {"fluid", "shape", "mesh", {"file"}, {"checksum", "scale", "rotate", "translate"}},
      {"wall", "shape", "polyline", {}, {"points", "points_file", "fluid_side"}},
      {"wall", "shape", "polygon", {}, {"points", "points_file", "fluid_side"}},
      {"wall", "shape", "box", {"min", "max"}, {"open", "fluid_side"}},
      {"wall", "shape", "plate", {}, {"points", "points_file", "file", "checksum", "scale", "rotate", "translate"}},
      {"wall", "shape", "mesh", {"file"}, {"checksum", "scale", "rotate", "translate", "fluid_side"}},
      {"wall", "slip", "free", {}, {}},
      {"wall", "slip", "no-slip", {}, {"roughness", "manning"}},
      {"wall", "slip", "partial", {}, {"friction"}},
      {"wall", "slip", "coulomb", {"friction"}, {}},
      {"porous", "shape", "box", {"min", "max"}, {}},
      {"porous", "shape", "polygon", {"points"}, {}},
      {"porous", "shape", "mesh", {"file"}, {"checksum", "scale", "rotate", "translate"}},
      {"refinement", "shape", "box", {"min", "max"}, {"displacement"}},
      {"refinement", "shape", "polygon", {"points"}, {"displacement"}},
      {"refinement", "shape", "walls", {"walls", "distance"}, {}},
      {"refinement", "shape", "surface", {"distance"}, {"displacement"}},
      {"porous", "resistance", "van-gent", {"grain_size"}, {"alpha", "beta", "keulegan_carpenter"}},
      {"porous", "resistance", "ergun", {"grain_size"}, {"alpha", "beta"}},
      {"porous", "resistance", "coefficients", {}, {"linear", "quadratic"}},
      {"liquid", "rheology", "newtonian", {"viscosity"}, {}},
      {"liquid", "rheology", "power-law", {"consistency", "index"}, {"rest_viscosity"}},
      {"liquid", "rheology", "bingham", {"viscosity", "yield_stress"}, {"rest_viscosity"}},
      {"liquid", "rheology", "herschel-bulkley", {"consistency", "index", "yield_stress"}, {"rest_viscosity"}},
      {"liquid", "rheology", "carreau", {"viscosity", "index", "relaxation_time"}, {"high_shear_viscosity"}},
      {"gate", "motion", "speed", {"speed"}, {"travel"}},
      {"gate", "motion", "acceleration", {"acceleration"}, {"travel"}},
      {"gate", "motion", "file", {"file"}, {"checksum"}},
      {"air", "pockets", "none", {}, {}},
      {"air", "pockets", "adiabatic", {}, {"pressure"}},
      {"air", "pockets", "isothermal", {}, {"pressure"}},
      {"scheme", "name", "farzin2014", {}, {"integrator"}},
      {"scheme", "name", "farmani2020", {}, {}},
      {"scheme", "formulation", "robust", {}, {"pair_vectors", "turbulence"}},
      {"scheme", "formulation", "published", {}, {}},
      {"probe", "type", "depth", {"at"}, {"liquid", "interval"}},
      {"probe", "type", "wall-pressure", {"at"}, {"diameter", "interval", "averaging_time"}},
      {"probe", "type", "wall-pressure-mean", {"from", "to"}, {"width", "interval", "averaging_time"}},
      {"probe", "type", "front", {}, {"direction", "liquid", "interval"}},
      {"probe", "type", "profile", {"from", "to", "times"}, {"liquid"}},
      {"probe", "type", "pressure", {"at"}, {"interval", "averaging_time"}},
      {"probe", "type", "velocity", {"at"}, {"liquid", "interval"}},
      {"probe", "type", "energy", {}, {"interval"}},
      {"probe", "type", "volume", {}, {"interval"}},
      {"probe", "type", "discharge", {"from", "to"}, {"direction", "interval"}},
      {"probe", "type", "force", {}, {"moment_about", "walls", "region_min", "region_max", "interval"}},
      {"probe", "type", "pressure-map", {}, {"walls", "region_min", "region_max", "interval", "averaging_time"}},
      {"probe", "type", "motion", {"body"}, {"interval"}},
      {"probe", "type", "run-up", {}, {"walls", "region_min", "region_max", "interval"}},
      {"probe", "type", "level-map", {"from", "to"}, {"step", "liquid", "interval"}},
      {"probe", "type", "velocity-profile", {"at"}, {"step", "times", "interval"}},
      {"probe", "type", "pockets", {}, {"interval"}},
  };
}

}  // namespace

bool KeyUse::needs(std::string_view key) const { return contains(needed, key); }
bool KeyUse::mentions(std::string_view key) const { return needs(key) || contains(possible, key); }

std::span<const KeyUse> key_uses() {
  static const std::vector<KeyUse> uses = [] {
    std::vector<KeyUse> all = uses_of_shapes_and_types();
    for (const KeyUse& use : uses_of_waves()) all.push_back(use);
    return all;
  }();
  return uses;
}

KeyVerdict key_verdict(std::string_view table, std::string_view key, std::span<const KeyInfo> rows) {
  std::string_view selector;
  for (const KeyUse& use : key_uses()) {
    if (use.table == table && use.mentions(key)) selector = use.selector;
  }
  if (selector.empty()) {
    return {};
  }
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const KeyInfo& info) { return info.key == selector; });
  TAILWATER_ASSERT(row != rows.end(), "a selector is a key of its table");
  for (const KeyUse& use : key_uses()) {
    if (use.table == table && use.selector == selector && toml_string(use.choice) == row->value) {
      const KeyNeed need = use.needs(key)                ? KeyNeed::needed
                           : contains(use.possible, key) ? KeyNeed::possible
                                                         : KeyNeed::unused;
      return {need, &use};
    }
  }
  return {};  // a choice that this table rejects, such as a zone of a solitary wave
}

bool has_study(const SchemeTable& scheme, std::string_view key) {
  if (scheme.formulation != Formulation::robust) return false;
  return scheme.name != SchemeName::farmani2020 || (key != "divergence_free" && key != "displacement");
}

std::string key_use_text(std::string_view table, std::string_view key) {
  std::string text;
  for (const KeyUse& use : key_uses()) {
    if (use.table == table && use.mentions(key)) {
      text += text.empty() ? fmt::format("{} = ", use.selector) : ", ";
      text += fmt::format("\"{}\"{}", use.choice, use.needs(key) ? " (needed)" : "");
    }
  }
  return text;
}

}  // namespace tailwater
