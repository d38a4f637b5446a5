#include <algorithm>

#include "base/assert.h"
#include "case/probe_columns.h"

namespace tailwater {
namespace probe_types {

using enum Measure;
using enum Parts;
using enum Comparison;
using enum Need;
using enum Statistic;

constexpr std::string_view above_atmosphere = "pressure above that of the atmosphere";

constexpr DeclaredColumn pressure_on_wall{"pressure", pressure, above_atmosphere, by_default};
constexpr DeclaredColumn impulse_on_wall{"impulse", impulse, "integral of the pressure over all steps since the start"};

// Computed from the impulse, so that no step between two lines of the table is left out.
const std::vector<DeclaredResult> wall_pressure_results{{"pressure", "", "impulse", rate},
                                                        {"largest pressure", "largest", "impulse", max_rate},
                                                        {"rise", "rise time", "impulse", rise},
                                                        {"impulse", "impulse", "impulse", last}};

const std::vector<ProbeInfo> of_surface{
    {ProbeType::depth,
     "Depth of the water on the vertical line through a place",
     {{"connected", length, "height of the water that is connected to the bed", by_default},
      {"highest", length, "height of the highest water above the bed, spray included", possible},
      {"wet", length, "length of the line that is under water, as a wire gauge reads it", possible}},
     {{"depth", "", "connected", mean}, {"highest water", "highest", "highest", max}},
     {{"mean", length, "time average of `highest_m`"},
      {"least", length, "minimum of `highest_m`"},
      {"largest", length, "maximum of `highest_m`"},
      {"waves", number, "number of waves; absent without waves, as are the heights and the period"},
      {"height_mean", length, "mean wave height"},
      {"height_third", length, "mean of the highest third of the wave heights"},
      {"height_largest", length, "largest wave height"},
      {"period_mean", time, "mean wave period"}}},
    {ProbeType::front,
     "Position of the front of the water",
     {{"front", length, "foremost edge of the water along `direction`, spray included", possible},
      {"front_connected", length, "foremost edge of the water, without drops and thin spray", by_default}},
     {{"front", "", "front_connected", last}}},
    {ProbeType::profile,
     "Depths along a line; one line of the table for each place",
     {{"x", length, "place"},
      {"y", length, "place", none, one_in_3d},
      {"bed", length, "height of the bed above the origin; in a tank that moves, where it is drawn"},
      {"connected", length, "height of the water that is connected to the bed", by_default},
      {"highest", length, "height of the highest water above the bed, spray included", possible}},
     {{"least depth", "depth from", "connected", last_min}, {"largest depth", "to", "connected", last_max}}},
    {ProbeType::run_up,
     "Height of the water on walls, above the origin",
     {{"connected", length, "highest wet place that no gap separates from the water below", by_default},
      {"highest", length, "highest wet place, drops included", possible}},
     {{"run-up", "", "connected", max}, {"highest drop", "highest wet place", "highest", max}},
     {{"largest_connected", length, "maximum of `connected_m`"},
      {"time_of_largest", time, "time of that maximum"},
      {"largest_highest", length, "maximum of `highest_m`"}}},
    {ProbeType::level_map,
     "Water levels in plan, above the origin, which moves with a tank; the map is `probes/NAME.map.csv` or "
     "`.vtp`",
     {{"highest", length, "maximum over the places", possible},
      {"mean", length, "average over the places", by_default}},
     {{"level", "", "mean", mean}, {"highest level", "highest", "highest", max}},
     {{"largest", length, "maximum of the run"},
      {"time_of_largest", time, "time of the maximum"},
      {"x", length, "place of the maximum"},
      {"y", length, "place of the maximum", none, one_in_3d},
      {"mean", length, "average over the places and over time"},
      {"last_mean", length, "average over the places of the last reading"}}},
};

const std::vector<ProbeInfo> of_pressure{
    {ProbeType::wall_pressure,
     "Pressure at a place on a wall, or averaged over a round sensor there",
     {pressure_on_wall,
      {"wet_share", number, "wet fraction of the sensor, if the probe has a `diameter`", none, one, diameter},
      impulse_on_wall},
     wall_pressure_results},
    {ProbeType::wall_pressure_mean,
     "Pressure averaged over a stretch or a rectangle of a wall",
     {pressure_on_wall, {"wet_share", number, "wet fraction of the stretch"}, impulse_on_wall},
     wall_pressure_results},
    {ProbeType::pressure,
     "Pressure at a point in the water",
     {{"pressure", pressure, above_atmosphere, by_default},
      {"wet", number, "1 under water; else 0, and the pressure is that of the air"}},
     {{"pressure", "", "pressure", mean}, {"largest pressure", "largest", "pressure", max_mean}}},
    {ProbeType::pressure_map,
     "Largest and mean pressure on walls; the map is `probes/NAME.vtp`",
     {{"largest", pressure, "maximum over the walls at this time", by_default},
      {"x", length, "place of the maximum, where the wall is now"},
      {"y", length, "place of the maximum, where the wall is now"},
      {"z", length, "place of the maximum, where the wall is now", none, one_in_3d},
      {"mean", pressure, "average over the walls", possible},
      {"wet_share", number, "wet fraction of the walls"}},
     {{"largest pressure", "largest", "largest", max_mean}},
     {{"largest", pressure, "maximum of the run over places and over means of `averaging_time`"},
      {"time_of_largest", time, "time of the maximum"},
      {"x", length, "place of the maximum, where the wall is drawn"},
      {"y", length, "place of the maximum, where the wall is drawn"},
      {"z", length, "place of the maximum, where the wall is drawn", none, one_in_3d},
      {"mean", pressure, "average over the walls and over time"}}},
    {ProbeType::force,
     "Force of the water on walls",
     {{"force", force, "force", by_default, vector},
      {"pressure", force, "force from pressure", none, vector},
      {"friction", force, "force from friction", none, vector},
      {"moment", moment, "moment of the force about `moment_about`, if the probe has that", possible, turn,
       moment_about},
      {"power_to_water", power, "power of the walls on the water, if a wall of the probe moves", none, one,
       moving_walls}},
     {{"force x", "x", "force_x", mean},
      {"force y", "y", "force_y", mean},
      {"force z", "z", "force_z", mean},
      {"largest force", "largest", "force_x", max_magnitude},
      {"moment", "moment", "moment", mean},
      {"moment x", "moment x", "moment_x", mean},
      {"moment y", "moment y", "moment_y", mean},
      {"moment z", "moment z", "moment_z", mean},
      {"largest moment", "largest moment", "moment", max_magnitude},
      {"largest moment", "largest moment", "moment_x", max_magnitude}},
     {{"largest", force, "maximum of the magnitude of the force"},
      {"time_of_largest", time, "time of the maximum"},
      {"mean", force, "time average of the force", none, vector}}},
};

const std::vector<ProbeInfo> of_flow{
    {ProbeType::velocity,
     "Velocity at a point in the water",
     {{"", speed, "velocity; 0 in air", by_default, velocity},
      {"wet", number, "1 under water, else 0"},
      {"shear_rate", shear_rate, "shear rate, if the probe has a `liquid`", none, one, liquid},
      {"viscosity", impulse, "viscosity of that liquid at this shear rate", none, one, liquid},
      {"shear_stress", pressure, "viscosity times shear rate", possible, one, liquid}},
     {{"u", "u", "u", mean}, {"v", "v", "v", mean}, {"w", "w", "w", mean}}},
    {ProbeType::velocity_profile,
     "Velocity over the depth; one line of the table for each height",
     {{"height", length, "height above the bed"},
      {"", speed, "velocity at that height", none, velocity},
      {"depth", length, "depth of the water"},
      {"mean_", speed, "average of the velocity over the depth", none, velocity}},
     {{"mean u", "u", "mean_u", last},
      {"mean v", "v", "mean_v", last},
      {"mean w", "w", "mean_w", last},
      {"depth", "depth", "depth", last}},
     {{"mean_depth", length, "time average of the depth"},
      {"mean_", speed, "time average of the average over the depth", none, velocity}}},
    {ProbeType::discharge,
     "Discharge through a section, positive along `direction`",
     {{"discharge", discharge, "rate of `volume_m3`, averaged over the last `averaged_over_s`", by_default},
      {"volume", volume, "volume that has passed since the start", possible}},
     {{"discharge", "", "volume", rate}, {"largest discharge", "largest", "discharge", max_moving_mean}},
     {{"largest", discharge, "maximum of `discharge_m3_per_s` from `averaged_over_s` on"},
      {"time_of_largest", time, "time of the maximum"},
      {"averaged_over", time, "time of the average"}}},
    {ProbeType::energy,
     "Mechanical energy of all water",
     {{"kinetic", energy, "kinetic energy", possible},
      {"potential", energy, "potential energy, relative to the origin", possible},
      {"total", energy, "kinetic plus potential energy", by_default}},
     {{"energy", "", "total", last}}},
    {ProbeType::volume,
     "Water in the domain, and water that has passed open ends",
     {{"particles", number, "number of water particles, without those in the ducts beyond openings"},
      {"density_error_mean", number, "mean relative density error away from the surface"},
      {"density_error_rms", number, "root mean square of that error"},
      {"volume_out", volume, "volume that has left through open ends", by_default},
      {"volume_in", volume, "volume that has entered through open ends", possible}},
     {{"particles", "particles", "particles", last},
      {"volume in", "in", "volume_in", last},
      {"volume out", "out", "volume_out", last}}},
};

const std::vector<ProbeInfo> of_bodies_and_air{
    {ProbeType::motion,
     "Motion of a floating body",
     {{"displacement", length, "displacement of the centre of mass from where it is drawn", by_default, vector},
      {"angle", angle, "angle of rotation with its whole turns; in 3D times its axis", possible, turn},
      {"velocity", speed, "velocity of the centre of mass", possible, vector},
      {"angular_velocity", angular_speed, "angular velocity", none, turn}},
     {{"displacement x", "x", "displacement_x", range},
      {"displacement y", "y", "displacement_y", range},
      {"displacement z", "z", "displacement_z", range},
      {"angle", "angle", "angle", range},
      {"angle about x", "angle about x", "angle_x", range},
      {"angle about y", "angle about y", "angle_y", range},
      {"angle about z", "angle about z", "angle_z", range}},
     {{"displacement", length, "minimum and maximum of the displacement", none, vector_range},
      {"angle", angle, "minimum and maximum of the angle", none, turn_range}}},
    {ProbeType::pockets,
     "Enclosed air",
     {{"pressure", pressure, "pressure of the largest pocket, above that of the atmosphere", by_default},
      {"volume", volume, "volume of all pockets", possible},
      {"gas", volume, "volume of their gas at the pressure of the atmosphere", possible},
      {"vented", volume, "volume of the gas that has left through vents, at that pressure", possible},
      {"energy", energy, "energy of the gas", possible},
      {"pockets", number, "number of pockets"}},
     {{"pressure", "", "pressure", range},
      {"volume", "volume", "volume", last},
      {"pockets", "pockets", "pockets", last}}},
};

}  // namespace probe_types

const ProbeInfo& info_of(ProbeType type) {
  using namespace probe_types;
  for (const auto* group : {&of_surface, &of_pressure, &of_flow, &of_bodies_and_air}) {
    const auto info = std::ranges::find(*group, type, &ProbeInfo::type);
    if (info != group->end()) return *info;
  }
  TAILWATER_ASSERT(false, "each type of probe is declared");
  return of_surface.front();
}

}  // namespace tailwater
