#include "case/across_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "case/formulation.h"
#include "case/key_use.h"
#include "case/named_numbers.h"
#include "case/nearest_name.h"
#include "case/rheology.h"

namespace tailwater {
namespace {

/// Checks an interval: a mistyped one would fill the disk, or make the run very slow.
void check_interval(double interval, double end, double most, const CaseLabel& key, const toml::node* node,
                    std::string_view what, std::string_view remedy, Problems& problems) {
  if (node == nullptr || interval <= 0.0 || end / interval <= most) return;
  problems.wrong("output-too-frequent", key, *node,
                 fmt::format("makes {:.3g} {} until time.end; give at least {:.3g} s, or 0: {}", end / interval, what,
                             end / most, remedy));
}

void check_amount_of_output(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  constexpr double max_lines = 1e8;
  constexpr double max_files = 1e6;
  check_interval(spec.output.fields_interval, spec.time.end, max_files, CaseLabel("output").with_key("fields_interval"),
                 root["output"]["fields_interval"].node(), "field files", "a hundred files", problems);
  check_interval(spec.output.view_interval, spec.time.end, max_files, CaseLabel("output").with_key("view_interval"),
                 root["output"]["view_interval"].node(), "frames", "four hundred frames", problems);
  for (std::size_t i = 0; i < spec.probes.size(); ++i) {
    check_interval(spec.probes[i].interval, spec.time.end, max_lines, CaseLabel("probe", i).with_key("interval"),
                   root["probe"][i]["interval"].node(), "lines", "a line at every step", problems);
  }
}

/// The surface of a fill is perpendicular to the last axis.
void check_levels_of_fills(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  const int dimension = spec.general.dimension;
  if (gravity_points_down(spec.physics)) return;
  for (std::size_t k = 0; k < spec.fluid.size(); ++k) {
    const toml::node* node = root["fluid"][k]["level"].node();
    if (spec.fluid[k].shape != BlockShape::fill || node == nullptr) continue;
    problems.wrong(
        "fill-gravity-not-down", CaseLabel("fluid", k).with_key("level"), *node,
        fmt::format(
            "is a height along {0}, but physics.gravity does not point down along {0}; turn the case so that it "
            "does, or draw the water as a box or a {1}",
            dimension == 2 ? "y" : "z", dimension == 2 ? "polygon" : "mesh"));
  }
}

/// Walls, gates and wave makers need different names, because messages identify them by name.
void check_names_of_driven_walls(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  std::set<std::string_view> names;
  for (const WallTable& wall : spec.walls) names.insert(wall.name);
  const auto add_names = [&](const char* table, const auto& tables) {
    for (std::size_t k = 0; k < tables.size(); ++k) {
      if (names.insert(tables[k].name).second) continue;
      const CaseLabel key = CaseLabel(table, k).with_key("name");
      problems.add(
          "name-of-wall-taken", &root[table][k].node()->source(), key,
          fmt::format("{} = \"{}\": a wall has this name too; give each a name of its own", key, tables[k].name));
    }
  };
  add_names("gate", spec.gates);
  add_names("wave_maker", spec.wave_makers);
}

/// Reports a `name` under `key`, as in "mooring[0].body", that none of `targets`, tables of one kind, has.
template <class Target>
void check_name(const std::string& name, const std::vector<Target>& targets, std::string_view kind,
                const CaseLabel& key, const toml::node& node, Problems& problems) {
  std::vector<std::string_view> names;
  for (const Target& target : targets) names.push_back(target.name);
  if (std::ranges::find(names, name) != names.end()) return;
  problems.wrong("name-unknown", key, node,
                 fmt::format("there is no {} \"{}\"; {}", kind, name, unknown_name_hint(name, names)));
}

/// Checks that a body is made of walls that have no other motion.
void check_bodies(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  std::map<std::string_view, std::string_view> body_of_wall;
  for (std::size_t k = 0; k < spec.bodies.size(); ++k) {
    const BodyTable& body = spec.bodies[k];
    const CaseLabel key = CaseLabel("body", k).with_key("walls");
    const auto wrong = [&](MessageId id, const std::string& message) {
      problems.wrong(id, key, *root["body"][k]["walls"].node(), message);
    };
    for (const std::string& name : body.walls) {
      const auto wall = std::ranges::find(spec.walls, name, &WallTable::name);
      if (wall == spec.walls.end()) {
        check_name(name, spec.walls, "wall", key, *root["body"][k]["walls"].node(), problems);
        continue;
      }
      const auto varies = [](const Varying& value) { return value != Varying(0.0); };
      const bool is_moved =
          varies(wall->rotation) || std::ranges::any_of(wall->displacement, varies) || !wall->series.empty();
      const bool is_closed = wall->shape == WallShape::polygon || wall->shape == WallShape::mesh ||
                             (wall->shape == WallShape::box && wall->open.empty());
      if (const auto [first, is_new] = body_of_wall.emplace(name, body.name); !is_new) {
        wrong("body-wall-shared",
              fmt::format("wall '{}' already belongs to body '{}'; remove it from one of them", name, first->second));
      } else if (is_moved) {
        wrong("body-wall-moves",
              fmt::format("wall '{}' has a motion of its own; remove its displacement, rotation and motion", name));
      } else if (!is_closed) {
        wrong("body-wall-open", fmt::format("wall '{}' is not closed, so the body has no volume; draw a polygon, a box "
                                            "without open faces, or a mesh",
                                            name));
      } else if (wall->shape != WallShape::mesh && wall->fluid_side != FluidSide::outside) {
        wrong("body-wall-water-inside",
              fmt::format("wall '{}' has the water inside; give it fluid_side = \"outside\"", name));
      }
    }
  }
  const std::string_view why_not = traits_of(spec).no_floating;
  if (!spec.bodies.empty() && !why_not.empty()) {
    problems.add("body-needs-robust", &root["body"][0].node()->source(), CaseLabel("body", 0),
                 fmt::format("body[0]: bodies float only with scheme.formulation = \"{}\" and scheme.name = \"{}\": "
                             "{}; choose these, or give the walls a motion",
                             name_of(Formulation::robust), name_of(SchemeName::farzin2014), why_not));
  }
}

/// Without a gas in enclosed air no space can start at another pressure, and no gas can be vented.
void check_no_air(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  const auto check_none = [&](const char* table, const auto& tables) {
    if (tables.empty()) return;
    problems.add("air-not-computed", &root[table][0].node()->source(), CaseLabel(table, 0),
                 fmt::format("{}[0]: enclosed air is not computed in this case; give pockets = \"{}\" or \"{}\" in "
                             "[air], or remove the table",
                             table, name_of(AirPockets::adiabatic), name_of(AirPockets::isothermal)));
  };
  check_none("pocket", spec.pockets);
  check_none("vent", spec.vents);
}

/// Enclosed air is implemented in the robust formulation, for walls whose motion is known.
void check_air(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  if (spec.air.pockets == AirPockets::none) check_no_air(spec, root, problems);
  for (std::size_t k = 0; k < spec.pockets.size(); ++k) {
    const toml::node* node = root["pocket"][k]["overpressure"].node();
    if (node == nullptr || spec.pockets[k].overpressure > -spec.air.pressure) continue;
    problems.wrong(
        "pocket-without-pressure", CaseLabel("pocket", k).with_key("overpressure"), *node,
        fmt::format("is not above a vacuum: the atmosphere has {:.9g} Pa (air.pressure); give more than {:.9g} Pa",
                    spec.air.pressure, -spec.air.pressure));
  }
  const toml::node* node = root["air"]["pockets"].node();
  if (spec.air.pockets == AirPockets::none || node == nullptr) return;
  const std::string_view why_not = traits_of(spec).no_pockets;
  if (why_not.empty()) return;
  problems.wrong(
      "air-needs-robust", CaseLabel("air").with_key("pockets"), *node,
      fmt::format(
          "is not possible with scheme.formulation = \"{}\": {}; choose formulation \"{}\", or pockets = \"{}\"",
          name_of(spec.scheme.formulation), why_not, name_of(Formulation::robust), name_of(AirPockets::none)));
}

/// Porous layers need the formulation in which bodies float, for a similar reason: the pressure equation must contain
/// the fraction of the pressure gradient that the grains take. Pockets of air cannot be combined with layers: they take
/// the space without water, and particles in a layer stand farther apart.
void check_porous(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  if (spec.porous.empty()) return;
  const auto wrong = [&](MessageId id, const std::string& message) {
    problems.add(id, &root["porous"][0].node()->source(), CaseLabel("porous", 0), "porous[0]: " + message);
  };
  if (!traits_of(spec).no_floating.empty()) {
    wrong("porous-needs-robust",
          fmt::format("porous layers are possible only with scheme.formulation = \"{}\" and scheme.name = \"{}\", and "
                      "without study.displacement; give these, remove that key, or remove the layers",
                      name_of(Formulation::robust), name_of(SchemeName::farzin2014)));
  }
  const bool has_coefficients = std::ranges::any_of(
      spec.porous, [](const PorousTable& layer) { return layer.resistance == PorousResistance::coefficients; });
  if (has_coefficients && gravity_magnitude(spec.physics) == 0.0) {
    wrong("porous-without-gravity",
          "without gravity there is no hydraulic gradient, so its coefficients have no meaning; give a grain_size and "
          "another resistance");
  }
  if (spec.air.pockets != AirPockets::none) {
    wrong("porous-beside-air",
          fmt::format("enclosed air is not computed beside porous layers; give pockets = \"{}\" in [air], or remove "
                      "the layers",
                      name_of(AirPockets::none)));
  }
}

/// Refuses features that are not computed with a thick liquid, and the two numbers of [physics] that it replaces.
void check_surroundings_of_liquid(const CaseSpec& spec, const toml::table& root, const LiquidTable& liquid,
                                  Problems& problems) {
  const auto check_number = [&](const char* key, double of_liquid) {
    const std::optional<double> given = root["physics"][key].value<double>();
    if (!given || *given == of_liquid) return;
    problems.wrong("liquid-has-own-value", CaseLabel("physics").with_key(key), *root["physics"][key].node(),
                   fmt::format("has no effect, because liquid \"{}\" has its own value; remove this key", liquid.name));
  };
  check_number("density", liquid.density);
  check_number("viscosity", kinematic_viscosity(liquid));
  if (!traits_of(spec).no_floating.empty()) {
    problems.add(
        "liquid-needs-robust", &root["liquid"][0].node()->source(), CaseLabel("liquid", 0),
        fmt::format("liquid[0]: liquids are possible only with scheme.formulation = \"{}\" and scheme.name = "
                    "\"{}\", and without study.displacement; give these, remove that key, or remove the liquid",
                    name_of(Formulation::robust), name_of(SchemeName::farzin2014)));
  }
  const auto refuse = [&](const char* table, bool is_there, std::string_view what) {
    if (!is_there) return;
    problems.add("table-beside-liquid", &root[table][0].node()->source(), CaseLabel(table, 0),
                 fmt::format("{}[0]: {} not computed with liquid \"{}\"; remove the table, or the liquid", table, what,
                             liquid.name));
  };
  for (std::size_t k = 0; k < spec.walls.size(); ++k) {
    for (const char* key : {"roughness", "manning"}) {
      const toml::node* node = root["wall"][k][key].node();
      if (node == nullptr || (spec.walls[k].roughness == 0.0 && spec.walls[k].manning == 0.0)) continue;
      problems.wrong("rough-wall-beside-liquid", CaseLabel("wall", k).with_key(key), *node,
                     fmt::format("walls beside liquid \"{}\" can only be smooth; remove the key", liquid.name));
    }
  }
  refuse("porous", !spec.porous.empty(), "porous layers are");
  for (std::size_t k = 0; has_several_liquids(spec) && k < spec.inlets.size(); ++k) {
    if (spec.inlets[k].water_from.empty()) continue;
    problems.wrong(
        "circuit-of-liquids", CaseLabel("inlet", k).with_key("water_from"), *root["inlet"][k]["water_from"].node(),
        fmt::format("a circuit has one liquid, and the case has \"{}\" and others; remove this key", liquid.name));
  }
  if (spec.physics.channel_width > 0.0) {
    problems.wrong("side-walls-beside-liquid", CaseLabel("physics").with_key("channel_width"),
                   *root["physics"]["channel_width"].node(),
                   fmt::format("friction of side walls is not computed with liquid \"{}\"; remove the key, or compute "
                               "in three dimensions",
                               liquid.name));
  }
  if (spec.air.pockets != AirPockets::none) {
    problems.wrong("air-beside-liquid", CaseLabel("air").with_key("pockets"), *root["air"]["pockets"].node(),
                   fmt::format("enclosed air is not computed with liquid \"{}\"; give \"{}\"", liquid.name,
                               name_of(AirPockets::none)));
  }
}

/// Blocks may be of several liquids, and all of them then name theirs.
void check_liquids_of_blocks(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  for (std::size_t k = 0; k < spec.fluid.size(); ++k) {
    const CaseLabel key = CaseLabel("fluid", k).with_key("liquid");
    const toml::node* node = root["fluid"][k]["liquid"].node();
    if (node != nullptr && !spec.fluid[k].liquid.empty()) {
      check_name(spec.fluid[k].liquid, spec.liquids, "liquid", key, *node, problems);
    } else if (has_several_liquids(spec)) {
      problems.add("block-without-liquid", &root["fluid"][k].node()->source(), key,
                   fmt::format("{} is missing, and other blocks have one; give the name of a [[liquid]], which may be "
                               "water: rheology = \"newtonian\", viscosity = 1e-3",
                               key));
    }
  }
  for (std::size_t k = 0; k < spec.probes.size(); ++k) {
    const toml::node* node = root["probe"][k]["liquid"].node();
    if (node == nullptr || spec.probes[k].liquid.empty()) continue;
    check_name(spec.probes[k].liquid, spec.liquids, "liquid", CaseLabel("probe", k).with_key("liquid"), *node,
               problems);
  }
}

/// The pressure equation converges for densities that differ by this factor, and its layers are tested up to it.
constexpr double largest_density_ratio = 10.0;

void check_densities(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  const auto [light, heavy] = std::ranges::minmax_element(spec.liquids, {}, &LiquidTable::density);
  if (heavy->density <= largest_density_ratio * light->density) return;
  const auto k = static_cast<std::size_t>(light - spec.liquids.begin());
  problems.add(
      "liquid-densities-too-far", &root["liquid"][k].node()->source(), CaseLabel("liquid", k),
      fmt::format("liquid[{}]: its density {:g} kg/m^3 is less than 1/{:g} of that of \"{}\", {:g} kg/m^3; give "
                  "densities within this ratio, and model air with [air] or as empty space",
                  k, light->density, largest_density_ratio, heavy->name, heavy->density));
}

/// The solve of viscous forces of liquids includes walls and open ends, but not all features that act on water.
void check_liquids(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  check_liquids_of_blocks(spec, root, problems);
  if (!problems.none()) return;
  for (std::size_t k = 0; k < spec.liquids.size(); ++k) {
    if (std::ranges::count(spec.fluid, spec.liquids[k].name, &FluidTable::liquid) > 0) continue;
    problems.add(
        "liquid-without-block", &root["liquid"][k].node()->source(), CaseLabel("liquid", k),
        fmt::format("liquid[{}]: no [[fluid]] has liquid \"{}\"; give a block liquid = \"{}\", or remove the table", k,
                    spec.liquids[k].name, spec.liquids[k].name));
  }
  if (const LiquidTable* const liquid = liquid_of(spec)) {
    check_surroundings_of_liquid(spec, root, *liquid, problems);
    check_densities(spec, root, problems);
  }
}

/// Studies change parts of the robust formulations; the published ones have none of these.
void check_study(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  const toml::table* study = root["study"].as_table();
  if (study == nullptr) return;
  const std::string scheme = spec.scheme.formulation == Formulation::robust
                                 ? fmt::format("name = \"{}\"", name_of(spec.scheme.name))
                                 : fmt::format("formulation = \"{}\"", name_of(spec.scheme.formulation));
  for (const auto& [key, node] : *study) {
    if (has_study(spec.scheme, key.str())) continue;
    problems.wrong("study-key-unused", CaseLabel("study").with_key(key.str()), node,
                   fmt::format("is not used with scheme.{}; remove it", scheme));
  }
}

/// Walls of the published formulations have rows of their own, without a limit of the tension.
void check_tension(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  const toml::node* const key = root["physics"]["tension"].node();
  if (key == nullptr || spec.physics.tension == 0.0 || spec.scheme.formulation == Formulation::robust) return;
  problems.wrong("tension-needs-robust", CaseLabel("physics").with_key("tension"), *key,
                 "is not used with scheme.formulation = \"published\"; remove it");
}

/// Checks the walls that zones of refinement name, gates and wave makers among them.
void check_walls_of_zones(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  std::vector<WallTable> walls = spec.walls;
  for (const GateTable& gate : spec.gates) walls.emplace_back().name = gate.name;
  for (const WaveMakerTable& maker : spec.wave_makers) walls.emplace_back().name = maker.name;
  for (std::size_t k = 0; k < spec.refinement.size(); ++k) {
    for (const std::string& name : spec.refinement[k].walls) {
      check_name(name, walls, "wall", CaseLabel("refinement", k).with_key("walls"),
                 *root["refinement"][k]["walls"].node(), problems);
    }
  }
}

void check_names_of_others(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  for (std::size_t k = 0; k < spec.moorings.size(); ++k) {
    const CaseLabel key = CaseLabel("mooring", k).with_key("body");
    for (const std::string& name : spec.moorings[k].bodies) {
      check_name(name, spec.bodies, "body", key, *root["mooring"][k]["body"].node(), problems);
    }
  }
  for (std::size_t k = 0; k < spec.inlets.size(); ++k) {
    const std::string& name = spec.inlets[k].water_from;
    if (name.empty()) continue;
    check_name(name, spec.outlets, "outlet", CaseLabel("inlet", k).with_key("water_from"),
               *root["inlet"][k]["water_from"].node(), problems);
  }
}

}  // namespace

void check_named_walls(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  check_bodies(spec, root, problems);
  check_walls_of_zones(spec, root, problems);
}

void check_across_tables(const CaseSpec& spec, const toml::table& root, Problems& problems) {
  check_liquids(spec, root, problems);  // first, as it ends early where an earlier problem was found
  check_amount_of_output(spec, root, problems);
  check_ends_of_series(spec, root, problems);
  check_levels_of_fills(spec, root, problems);
  check_names_of_driven_walls(spec, root, problems);
  check_air(spec, root, problems);
  check_porous(spec, root, problems);
  check_study(spec, root, problems);
  check_tension(spec, root, problems);
  check_names_of_others(spec, root, problems);
}

}  // namespace tailwater
