#include "case/table_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "case/formulation.h"
#include "case/key_rules.h"
#include "case/key_use.h"
#include "case/rheology.h"

namespace tailwater {

void set_defaults(SchemeTable& scheme, TableReader& reader) {
  reader.read_ahead(scheme, {"name", "formulation", "integrator"});
  apply_formulation(scheme);
}

void set_defaults(FluidTable& fluid, TableReader& reader) {
  fluid.velocity.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  fluid.rotate.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  fluid.translate = fluid.rotate;
}

void set_defaults(WallTable& wall, TableReader& reader) {
  reader.read_ahead(wall, {"shape"});
  wall.fluid_side = wall.shape == WallShape::polyline ? FluidSide::left : FluidSide::inside;
  wall.displacement.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.pivot.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.rotate = wall.translate = wall.axis = wall.pivot;
}

void set_defaults(WaveMakerTable& maker, TableReader& reader) {
  reader.read_ahead(maker, {"waves", "period"});
  maker.ramp = 2.0 * maker.period;
}

void set_defaults(DampingTable& damping, TableReader& reader) {
  reader.read_ahead(damping, {"waves", "period"});
  damping.ramp = 2.0 * damping.period;
}

void set_defaults(BodyTable& body, TableReader& reader) {
  const std::vector<std::string> in_plane{"x", "y", "rotation"};
  const std::vector<std::string> in_space{"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
  body.free = reader.dimension() == 3 ? in_space : in_plane;
  body.velocity.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(RefinementTable& zone, TableReader& reader) {
  zone.displacement.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(PorousTable& porous, TableReader& reader) {
  porous.rotate.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  porous.translate = porous.rotate;
  reader.read_ahead(porous, {"porosity", "resistance"});
  if (porous.resistance == PorousResistance::ergun) {
    porous.alpha = 150.0;
    porous.beta = 1.75;
  }
  constexpr double added_mass_of_grains = 0.34;  // gamma_p of van Gent (1995)
  if (porous.porosity > 0.0) porous.added_mass = added_mass_of_grains * (1.0 - porous.porosity) / porous.porosity;
}

void set_defaults(LiquidTable& liquid, TableReader& reader) {
  reader.read_ahead(liquid, {"rheology", "viscosity", "consistency", "index", "yield_stress"});
  liquid.rest_viscosity = default_rest_viscosity(liquid);
}

void set_defaults(ProbeTable& probe, TableReader& reader) {
  reader.read_ahead(probe, {"type"});
  if (probe.type == ProbeType::front || probe.type == ProbeType::discharge) probe.direction = along_x(reader);
}

void set_defaults(InletTable& inlet, TableReader& reader) { inlet.direction = along_x(reader); }

void set_defaults(OutletTable& outlet, TableReader& reader) { outlet.direction = along_x(reader); }

void check(const PhysicsTable& physics, TableReader& reader) {
  const toml::node* node = reader.given("channel_width");
  if (node != nullptr && physics.channel_width > 0.0 && reader.dimension() == 3) {
    reader.wrong("channel-width-in-3d", "channel_width",
                 "replaces the side walls that are missing in two dimensions, but case.dimension = 3; remove it and "
                 "give the side walls as [[wall]] tables");
  }
  if (physics.channel_roughness > 0.0 && physics.channel_width == 0.0 && !reader.is_wrong("channel_width")) {
    reader.wrong("channel-roughness-without-width", "channel_roughness",
                 "has no effect without channel_width; give the width of the channel, or remove this key");
  }
}

void check(const FluidTable& fluid, TableReader& reader) {
  const int dimension = fluid.shape == BlockShape::polygon ? 2 : fluid.shape == BlockShape::mesh ? 3 : 0;
  check_shape_dimension(name_of(fluid.shape), dimension,
                        dimension == 2 ? "\"box\", \"mesh\" or \"fill\"" : "\"box\", \"polygon\" or \"fill\"", reader);
  check_box(fluid.min, fluid.max, reader);
  check_corner_count(fluid.points, 3, reader);
}

void check(const PorousTable& porous, TableReader& reader) {
  const int dimension = porous.shape == RegionShape::polygon ? 2 : porous.shape == RegionShape::mesh ? 3 : 0;
  check_shape_dimension(name_of(porous.shape), dimension,
                        dimension == 2 ? "\"box\" or \"mesh\"" : "\"box\" or \"polygon\"", reader);
  check_box(porous.min, porous.max, reader);
  check_corner_count(porous.points, 3, reader);
  const bool has_law = porous.resistance != PorousResistance::coefficients || reader.is_wrong("resistance") ||
                       reader.is_wrong("linear") || reader.is_wrong("quadratic");
  if (!has_law && reader.given("linear") == nullptr && reader.given("quadratic") == nullptr) {
    reader.missing("resistance-without-law", "linear",
                   "resistance = \"coefficients\" needs it: give linear (a) or quadratic (b) of the hydraulic gradient "
                   "a v + b v |v|, or both");
  }
}

void check(const LiquidTable& liquid, TableReader& reader) {
  if (liquid.rheology != Rheology::carreau) return;
  const bool is_wrong =
      reader.is_wrong("viscosity") || reader.is_wrong("high_shear_viscosity") || reader.is_wrong("index");
  if (is_wrong) return;
  if (reader.given("high_shear_viscosity") != nullptr && liquid.high_shear_viscosity >= liquid.viscosity) {
    reader.wrong("high-shear-viscosity", "high_shear_viscosity",
                 "is not below the viscosity at rest, {:.6g} Pa s (viscosity); give a smaller one, or choose rheology "
                 "= \"newtonian\"",
                 liquid.viscosity);
  }
  if (liquid.index > 1.0) {
    reader.wrong("carreau-index", "index", "is above 1, so the viscosity would exceed that at rest; give at most 1");
  }
}

namespace {

/// Checks that a plate is drawn either by points or by a mesh.
void check_mesh_of_plate(const WallTable& wall, TableReader& reader) {
  if (reader.is_wrong("file")) return;
  if (reader.dimension() == 2) {
    reader.wrong("mesh-in-2d", "file",
                 "a mesh has three dimensions, but case.dimension = 2; give points or a points_file");
  } else if (!wall.points_file.empty() || reader.given("points") != nullptr) {
    reader.wrong("points-given-twice", "file", "the wall has points as well; remove one of the two keys");
  }
}

/// Checks that a chain has its points either in the case or in a file.
void check_points_given(const WallTable& wall, TableReader& reader) {
  if (wall.shape == WallShape::box || wall.shape == WallShape::mesh) return;
  if (wall.shape == WallShape::plate && !wall.file.empty()) {
    check_mesh_of_plate(wall, reader);
    return;
  }
  const bool has_file = !wall.points_file.empty();
  if (has_file && reader.given("points") != nullptr) {
    reader.wrong("points-given-twice", "points_file", "the wall has points as well; remove one of the two keys");
  } else if (!has_file && reader.given("points") == nullptr && !reader.is_wrong("shape") &&
             !reader.is_wrong("points_file")) {
    reader.missing(
        "points-missing", "points",
        fmt::format("shape = \"{}\" needs it: give its corners in m, or a {}", name_of(wall.shape),
                    wall.shape == WallShape::plate && reader.dimension() == 3 ? "mesh file" : "points_file"));
  }
}

void check_fluid_side(const WallTable& wall, TableReader& reader) {
  if (wall.shape == WallShape::plate || reader.is_wrong("shape") || reader.is_wrong("fluid_side")) return;
  const toml::node* node = reader.given("fluid_side");
  const FluidSide side = wall.fluid_side;
  const bool is_chain_side = side == FluidSide::left || side == FluidSide::right;
  const bool is_body_side = side == FluidSide::inside || side == FluidSide::outside;
  if (wall.shape == WallShape::mesh) {
    constexpr std::string_view sides =
        "\"inside\" or \"outside\" of a closed mesh, \"above\" or \"below\" an open one, or its \"front\" or \"back\"";
    if (node == nullptr) {
      reader.missing("mesh-fluid-side-missing", "fluid_side", fmt::format("a mesh needs it; give {}", sides));
    } else if (is_chain_side) {
      reader.wrong("fluid-side-of-shape", "fluid_side", "does not fit shape = \"{}\"; give {}", name_of(wall.shape),
                   sides);
    }
    return;
  }
  const bool is_chain = wall.shape == WallShape::polyline;
  if (is_chain ? is_chain_side : is_body_side) return;
  reader.wrong("fluid-side-of-shape", "fluid_side", "does not fit shape = \"{}\"; give {}", name_of(wall.shape),
               is_chain ? "\"left\" or \"right\"" : "\"inside\" or \"outside\"");
}

/// Checks that the motion of a wall is given either by expressions or by a file, and that in 3D it turns about an axis.
void check_wall_motion(const WallTable& wall, TableReader& reader) {
  const auto is_zero = [](const Varying& value) { return value == Varying(0.0); };
  const auto refuse = [&](std::string_view key) {
    reader.wrong("motion-given-twice", key, "the wall has a motion from a file as well; remove one of the two keys");
  };
  if (!wall.motion.empty() && !std::ranges::all_of(wall.displacement, is_zero)) refuse("displacement");
  if (!wall.motion.empty() && !is_zero(wall.rotation)) refuse("rotation");
  const bool has_axis = std::ranges::any_of(wall.axis, [](double c) { return c != 0.0; });
  if (reader.dimension() == 2 && has_axis) {
    reader.wrong("axis-in-2d", "axis", "in 2D walls turn only about their pivot; remove the key");
  }
  if (reader.dimension() != 3 || wall.rotation == Varying(0.0)) return;
  check_turning_in_3d(wall, "rotation", reader);
}

}  // namespace

void check(const WallTable& wall, TableReader& reader) {
  switch (wall.shape) {
    case WallShape::polyline:
    case WallShape::polygon:
      check_shape_dimension(name_of(wall.shape), 2, "\"box\" or \"mesh\"", reader);
      break;
    case WallShape::mesh:
      check_shape_dimension(name_of(wall.shape), 3, "\"polyline\", \"polygon\" or \"box\"", reader);
      break;
    case WallShape::box:
    case WallShape::plate:
      break;
  }
  check_points_given(wall, reader);
  check_box(wall.min, wall.max, reader);
  check_corner_count(wall.points, min_corners(wall.shape, reader.dimension()), reader);
  if (const toml::node* node = reader.given("open"); node != nullptr && reader.dimension() == 2) {
    for (const std::string& face : wall.open) {
      if (face.ends_with('z')) {
        reader.wrong("face-in-2d", "open", "a 2D box has no face \"{}\"; remove it", face);
      }
    }
  }
  check_fluid_side(wall, reader);
  check_wall_motion(wall, reader);
  if (wall.roughness > 0.0 && wall.manning > 0.0) {
    reader.wrong("roughness-given-twice", "manning", "the wall has a roughness as well; remove one of the two keys");
  }
}

namespace {

/// Checks that an opening has one section, drawn in one way.
void check_section(const Section& section, TableReader& reader) {
  check_direction(section.direction, reader);
  check_ends(section.from, section.to, reader);
  const std::pair<std::string_view, bool> ways[] = {{"from", !section.from.empty() || !section.to.empty()},
                                                    {"polygon", !section.polygon.empty()},
                                                    {"centre", !section.centre.empty()},
                                                    {"through", !section.through.empty()}};
  std::vector<std::string_view> given;
  for (const auto& [key, is_given] : ways) {
    if (!is_given && !reader.is_wrong(key)) continue;
    given.push_back(key);
    if (key != "from" && reader.dimension() == 2 && !reader.is_wrong(key)) {
      reader.wrong("section-in-2d", key, "exists in three dimensions only; give from and to, the ends of a segment");
    }
  }
  if (given.size() > 1 && !reader.is_wrong(given[1])) {
    reader.wrong("section-given-twice", given[1],
                 "describes the section a second time, beside {}; remove one of the two", given[0]);
  }
  const bool has_ends = given.empty() || given[0] == "from";
  if (has_ends && section.from.empty() && !reader.is_wrong("from")) {
    reader.missing("section-from-missing", "from", "give the start of the opening");
  }
  if (has_ends && section.to.empty() && !reader.is_wrong("to"))
    reader.missing("section-to-missing", "to", "give the end of the opening");
  if (!section.polygon.empty() && section.polygon.size() < 3 && !reader.is_wrong("polygon")) {
    reader.wrong("section-too-few-corners", "polygon", "has {} corners; give three or more", section.polygon.size());
  }
  if (!section.centre.empty() && section.radius == 0.0 && !reader.is_wrong("radius")) {
    reader.missing("section-radius-missing", "radius", "give the radius of the disc around centre");
  }
  if (section.radius > 0.0 && section.centre.empty() && !reader.is_wrong("radius")) {
    reader.wrong("section-centre-missing", "radius", "is the radius of a disc, whose centre is missing; give centre");
  }
}

}  // namespace

void check(const InletTable& inlet, TableReader& reader) {
  check_section(inlet, reader);
  if (inlet.reserve > 0.0 && inlet.water_from.empty() && !reader.is_wrong("reserve")) {
    reader.wrong(
        "reserve-without-circuit", "reserve",
        "has no effect without water_from; give water_from, the name of the outlet whose water enters, or remove it");
  }
}

void check(const OutletTable& outlet, TableReader& reader) {
  check_section(outlet, reader);
  if (outlet.beyond == Beyond::air && may_bring_water(outlet) && !reader.is_wrong("beyond")) {
    reader.wrong("level-beyond-air", "beyond",
                 "the water leaves as a free jet, on which a level has no effect; remove this key or the level");
  }
}

namespace {

/// Checks the region that limits a probe to a part of the walls: a box, which may be flat.
void check_region(const ProbeTable& probe, TableReader& reader) {
  const toml::node* min = reader.given("region_min");
  const toml::node* max = reader.given("region_max");
  if (reader.is_wrong("region_min") || reader.is_wrong("region_max")) return;
  if ((min == nullptr) != (max == nullptr)) {
    const bool lacks_max = max == nullptr;
    reader.wrong("region-corner-missing", lacks_max ? "region_min" : "region_max", lacks_max ? *min : *max,
                 fmt::format("is one corner of a box; give {} as well", lacks_max ? "region_max" : "region_min"));
    return;
  }
  for (std::size_t d = 0; d < std::min(probe.region_min.size(), probe.region_max.size()); ++d) {
    if (probe.region_max[d] < probe.region_min[d]) {
      reader.wrong("region-max-below-min", "region_max", *max,
                   fmt::format("lies below region_min in {}: {} and {}; exchange them", "xyz"[d], probe.region_min[d],
                               probe.region_max[d]));
    }
  }
}

}  // namespace

void check(const ProbeTable& probe, TableReader& reader) {
  check_region(probe, reader);
  check_direction(probe.direction, reader);
  if (const toml::node* node = reader.given("times"); node != nullptr && !reader.is_wrong("times")) {
    const bool is_rising =
        std::adjacent_find(probe.times.begin(), probe.times.end(), std::greater_equal<>()) == probe.times.end();
    const bool are_needed = probe.type == ProbeType::profile;
    if (probe.times.empty() ? are_needed : probe.times.front() < 0.0 || !is_rising) {
      reader.wrong("times-not-rising", "times", "give at least one time in s, none negative, in increasing order");
    }
  }
  check_ends(probe.from, probe.to, reader);
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (const toml::node* node = reader.given("name"); node != nullptr && !reader.is_wrong("name")) {
    const bool is_file_name = std::all_of(probe.name.begin(), probe.name.end(), is_plain) && !probe.name.empty() &&
                              probe.name.front() != '-' && probe.name.size() <= 100;
    if (!is_file_name) {
      reader.wrong("probe-name-not-file", "name",
                   "cannot be a file name; use up to 100 letters, digits, _ and -, and do not begin with -");
    }
  }
}

void check(const DomainTable& domain, TableReader& reader) {
  const auto check_period = [&](std::string_view key, const std::vector<double>& range, int min_dimension) {
    const toml::node* node = reader.given(key);
    if (node == nullptr || reader.is_wrong(key) || range.empty()) return;
    if (range.size() != 2) {
      reader.wrong("range-expected", key, "give two numbers in m, [low, high], or remove the key");
    } else if (range[0] >= range[1]) {
      reader.wrong("range-empty", key, "is empty; give [low, high] with low below high, in m");
    } else if (reader.dimension() != 0 && reader.dimension() < min_dimension) {
      reader.wrong("period-z-in-2d", key, "a 2D case has no z; remove the key");
    }
  };
  check_period("periodic_x", domain.periodic_x, 2);
  check_period("periodic_y", domain.periodic_y, 2);
  check_period("periodic_z", domain.periodic_z, 3);
}

/// Reports keys that the chosen shape or type needs or does not use.
void check_key_uses(std::string_view table, std::span<const KeyInfo> rows, TableReader& reader) {
  for (const KeyInfo& info : rows) {
    const auto [need, use] = key_verdict(table, info.key, rows);
    if (use == nullptr || reader.is_wrong(use->selector)) continue;
    const std::string choice = fmt::format("{} = \"{}\"", use->selector, use->choice);
    const toml::node* node = reader.given(info.key);
    if (need == KeyNeed::needed && node == nullptr) {
      reader.missing("key-missing-for-choice", info.key,
                     fmt::format("{} needs it: {}{}", choice, info.doc, in_unit(info.unit)));
    } else if (need == KeyNeed::needed && node->is_string() && node->as_string()->get().empty()) {
      reader.wrong("key-empty-for-choice", info.key, "is empty, and {} needs it: {}", choice, info.doc);
    } else if (need == KeyNeed::unused && node != nullptr) {
      reader.wrong("key-unused", info.key, "is not used with {}; remove it (it goes with {})", choice,
                   key_use_text(table, info.key));
    }
  }
}

}  // namespace tailwater
