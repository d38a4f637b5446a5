#include "run/checkpoint_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/saved.h"

namespace tailwater {

void require_fit(bool condition, const char* part) {
  if (!condition) throw IoError("its '{}' does not fit", part);
}

TAILWATER_SAVED(inline, MakerState, correction, rate, time)

namespace {

template <class Numbers>
std::vector<double> list_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

template <class Numbers>
void take_list(const Json& json, Numbers& numbers) {
  const auto list = json.get<std::vector<double>>();
  require_fit(list.size() == static_cast<std::size_t>(numbers.size()) &&
                  std::ranges::all_of(list, [](double number) { return std::isfinite(number); }),
              "bodies");
  std::ranges::copy(list, numbers.data());
}

template <int Dim>
Json body_json(const BodyState<Dim>& body) {
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
BodyState<Dim> body_of(const Json& json) {
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

}  // namespace

template <int Dim>
std::string text_of(const Checkpoint<Dim>& checkpoint) {
  // A new member of State or StepMemory does not compile here until it is saved.
  const auto& [time, step, particles, wall_velocity, motion, last_step] = checkpoint.flow.state;
  const auto& [approach, energy_rise, density_share, fullness, lowest_beside_air, lowest_unbalanced, balanced_share,
               unbalanced_share] = last_step;
  Json json{{"time", time},
            {"step", step},
            {"approach", approach},
            {"energy_rise", energy_rise},
            {"density_share", density_share},
            {"fullness", fullness},
            {"lowest_beside_air", lowest_beside_air},
            {"lowest_unbalanced", lowest_unbalanced},
            {"balanced_share", balanced_share},
            {"unbalanced_share", unbalanced_share},
            {"reference_step", checkpoint.reference_step},
            {"wave_makers", motion.wave_makers},
            {"bodies", Json::array()},
            {"inertia", motion.bodies.inertia},
            {"parts", checkpoint.flow.parts},
            {"output", checkpoint.output}};
  for (const BodyState<Dim>& body : motion.bodies.each) json["bodies"].push_back(body_json(body));
  return json.dump(1);
}

template <int Dim>
void take_text(const std::string& text, Checkpoint<Dim>& checkpoint) {
  const Json json = Json::parse(text);
  State<Dim>& state = checkpoint.flow.state;
  state.time = json.at("time");
  state.step = json.at("step");
  state.last_step = {.approach = json.at("approach"),
                     .energy_rise = json.at("energy_rise"),
                     .density_share = json.at("density_share"),
                     .fullness = json.at("fullness"),
                     .lowest_beside_air = json.at("lowest_beside_air"),
                     .lowest_unbalanced = json.at("lowest_unbalanced"),
                     .balanced_share = json.at("balanced_share"),
                     .unbalanced_share = json.at("unbalanced_share")};
  checkpoint.reference_step = json.at("reference_step");
  json.at("wave_makers").get_to(state.motion.wave_makers);
  for (const Json& body : json.at("bodies")) state.motion.bodies.each.push_back(body_of<Dim>(body));
  json.at("inertia").get_to(state.motion.bodies.inertia);
  checkpoint.flow.parts = json.at("parts");
  checkpoint.output = json.at("output");
}

TAILWATER_IN_2D_AND_3D(text_of);
TAILWATER_IN_2D_AND_3D(take_text);

}  // namespace tailwater
