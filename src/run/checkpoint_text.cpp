#include "run/checkpoint_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"

namespace tailwater {
namespace {

nlohmann::json json_of(const Passed& passed) {
  const auto& [particles, volume, energy] = passed;
  return {{"particles", particles}, {"volume", volume}, {"energy", energy}};
}

Passed passed_of(const nlohmann::json& json) { return {json.at("particles"), json.at("volume"), json.at("energy")}; }

nlohmann::json json_of(const LevelMiss& miss) {
  const auto& [mean, lasts, since, total, most] = miss;
  return {{"mean", mean}, {"lasts", lasts}, {"since", since}, {"total", total}, {"most", most}};
}

LevelMiss miss_of(const nlohmann::json& json) {
  return {json.at("mean"), json.at("lasts"), json.at("since"), json.at("total"), json.at("most")};
}

nlohmann::json json_of(const OpenEndState& end) {
  const auto& [is_wet, wet_time, speed, speed_beyond, invariant, mean_speed, depth, depth_rate, entry_speed,
               depth_at_gauge, depth_in_middle, border_speed, gain, miss, asked, rows, departed, arrived, short_steps] =
      end;
  return {{"is_wet", is_wet},
          {"wet_time", wet_time},
          {"speed", speed},
          {"speed_beyond", speed_beyond},
          {"invariant", invariant},
          {"mean_speed", mean_speed},
          {"depth", depth},
          {"depth_rate", depth_rate},
          {"entry_speed", entry_speed},
          {"depth_at_gauge", depth_at_gauge},
          {"depth_in_middle", depth_in_middle},
          {"border_speed", border_speed},
          {"gain", gain},
          {"miss", json_of(miss)},
          {"asked", asked},
          {"rows", rows},
          {"departed", json_of(departed)},
          {"arrived", json_of(arrived)},
          {"short_steps", short_steps}};
}

OpenEndState open_end_of(const nlohmann::json& json) {
  return {json.at("is_wet"),
          json.at("wet_time"),
          json.at("speed"),
          json.at("speed_beyond"),
          json.at("invariant"),
          json.at("mean_speed"),
          json.at("depth"),
          json.at("depth_rate"),
          json.at("entry_speed"),
          json.at("depth_at_gauge"),
          json.at("depth_in_middle"),
          json.at("border_speed"),
          json.at("gain"),
          miss_of(json.at("miss")),
          json.at("asked"),
          json.at("rows"),
          passed_of(json.at("departed")),
          passed_of(json.at("arrived")),
          json.at("short_steps")};
}

nlohmann::json json_of(const MakerState& maker) {
  const auto& [correction, rate, time] = maker;
  return {{"correction", correction}, {"rate", rate}, {"time", time}};
}

MakerState maker_of(const nlohmann::json& json) { return {json.at("correction"), json.at("rate"), json.at("time")}; }

template <class Numbers>
std::vector<double> list_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

template <class Numbers>
void take_list(const nlohmann::json& json, Numbers& numbers) {
  const auto list = json.get<std::vector<double>>();
  require_fit(list.size() == static_cast<std::size_t>(numbers.size()) &&
                  std::ranges::all_of(list, [](double number) { return std::isfinite(number); }),
              "bodies");
  std::ranges::copy(list, numbers.data());
}

template <int Dim>
nlohmann::json json_of(const BodyState<Dim>& body) {
  const auto& [time, placement, centre, velocity, acceleration, carried_over] = body;
  return {{"time", time},
          {"turn", list_of(placement.linear)},
          {"shift", list_of(placement.constant)},
          {"centre", list_of(centre)},
          {"velocity", list_of(velocity)},
          {"acceleration", list_of(acceleration)},
          {"carried_over", list_of(carried_over)}};
}

template <int Dim>
BodyState<Dim> body_of(const nlohmann::json& json) {
  BodyState<Dim> body;
  body.time = json.at("time");
  take_list(json.at("turn"), body.placement.linear);
  take_list(json.at("shift"), body.placement.constant);
  take_list(json.at("centre"), body.centre);
  take_list(json.at("velocity"), body.velocity);
  take_list(json.at("acceleration"), body.acceleration);
  take_list(json.at("carried_over"), body.carried_over);
  return body;
}

nlohmann::json json_of(const AirState& air) {
  const auto& [pockets, begun, ended, displacement, gas_found, gas_lost, gas_vented, energy_lost, energy_vented,
               energy_set] = air;
  nlohmann::json json{{"begun", begun},
                      {"ended", ended},
                      {"displacement", displacement},
                      {"gas_found", gas_found},
                      {"gas_lost", gas_lost},
                      {"gas_vented", gas_vented},
                      {"energy_lost", energy_lost},
                      {"energy_vented", energy_vented},
                      {"energy_set", energy_set},
                      {"pockets", nlohmann::json::array()}};
  for (const auto& [number, gas, volume, torn, cells] : pockets) {
    std::vector<std::int32_t> runs;
    for (const auto& [row, begin, end] : cells) runs.insert(runs.end(), {row, begin, end});
    json["pockets"].push_back(
        {{"number", number}, {"gas", gas}, {"volume", volume}, {"torn", torn}, {"cells", std::move(runs)}});
  }
  return json;
}

AirState air_of(const nlohmann::json& json) {
  AirState air{{},
               json.at("begun"),
               json.at("ended"),
               json.at("displacement"),
               json.at("gas_found"),
               json.at("gas_lost"),
               json.at("gas_vented"),
               json.at("energy_lost"),
               json.at("energy_vented"),
               json.at("energy_set")};
  for (const nlohmann::json& each : json.at("pockets")) {
    AirPocket pocket{each.at("number"), each.at("gas"), each.at("volume"), each.at("torn"), {}};
    const auto runs = each.at("cells").get<std::vector<std::int32_t>>();
    require_fit(runs.size() % 3 == 0 && pocket.gas >= 0.0 && pocket.volume > 0.0, "air");
    for (std::size_t k = 0; k < runs.size(); k += 3) pocket.cells.push_back({runs[k], runs[k + 1], runs[k + 2]});
    air.pockets.push_back(std::move(pocket));
  }
  return air;
}

}  // namespace

void require_fit(bool condition, const char* part) {
  if (!condition) throw IoError(fmt::format("its '{}' does not fit", part));
}

template <int Dim>
std::string text_of(const Checkpoint<Dim>& checkpoint) {
  // A member that is new in State does not compile here until it is saved.
  const auto& [time, step, particles, wall_velocity, open_ends, section_volumes, motion, approach, energy_rise,
               density_share, air, fallen] = checkpoint.state;
  nlohmann::json json{{"time", time},
                      {"step", step},
                      {"approach", approach},
                      {"energy_rise", energy_rise},
                      {"density_share", density_share},
                      {"air", json_of(air)},
                      {"fallen", json_of(fallen)},
                      {"reference_step", checkpoint.reference_step},
                      {"open_ends", nlohmann::json::array()},
                      {"wave_makers", nlohmann::json::array()},
                      {"bodies", nlohmann::json::array()},
                      {"inertia", motion.bodies.inertia},
                      {"section_volumes", section_volumes},
                      {"output", checkpoint.output}};
  for (const OpenEndState& end : open_ends) json["open_ends"].push_back(json_of(end));
  for (const MakerState& maker : motion.wave_makers) json["wave_makers"].push_back(json_of(maker));
  for (const BodyState<Dim>& body : motion.bodies.each) json["bodies"].push_back(json_of(body));
  return json.dump(1);
}

template <int Dim>
void take_text(const std::string& text, Checkpoint<Dim>& checkpoint) {
  const nlohmann::json json = nlohmann::json::parse(text);
  State<Dim>& state = checkpoint.state;
  state.time = json.at("time");
  state.step = json.at("step");
  state.approach = json.at("approach");
  state.energy_rise = json.at("energy_rise");
  state.density_share = json.at("density_share");
  state.air = air_of(json.at("air"));
  state.fallen = passed_of(json.at("fallen"));
  checkpoint.reference_step = json.at("reference_step");
  for (const nlohmann::json& end : json.at("open_ends")) state.open_ends.push_back(open_end_of(end));
  for (const nlohmann::json& maker : json.at("wave_makers")) state.motion.wave_makers.push_back(maker_of(maker));
  for (const nlohmann::json& body : json.at("bodies")) state.motion.bodies.each.push_back(body_of<Dim>(body));
  json.at("inertia").get_to(state.motion.bodies.inertia);
  json.at("section_volumes").get_to(state.section_volumes);
  checkpoint.output = json.at("output");
}

TAILWATER_IN_2D_AND_3D(text_of);
TAILWATER_IN_2D_AND_3D(take_text);

}  // namespace tailwater
