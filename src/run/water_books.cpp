#include "run/water_books.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/for_each.h"

namespace tailwater {
namespace {

nlohmann::ordered_json json_of(const Water& water, double density) {
  return {{"particles", water.particles}, {"volume_m3", water.volume}, {"mass_kg", density * water.volume}};
}

/// The box around all walls and open ends; empty if there are none.
template <int Dim>
Eigen::AlignedBox<double, Dim> box_around(const Flow<Dim>& flow) {
  Eigen::AlignedBox<double, Dim> box;
  for (const WallFace<Dim>& face : flow.walls.boundary.faces) box.extend(face.box());
  for (const OpenEnd<Dim>& end : flow.setup.open_ends) {
    for (const WallFace<Dim>& face : end.opening.as_faces()) box.extend(face.box());
  }
  return box;
}

/// Whether a body that falls from x meets the box, or is in it.
template <int Dim>
bool falls_into(const Eigen::AlignedBox<double, Dim>& box, const Vec<Dim>& x, const Vec<Dim>& gravity) {
  double from = 0.0;  // of the way x + s gravity, the part within the box in all directions so far
  double to = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < Dim; ++axis) {
    const double to_low = box.min()[axis] - x[axis];
    const double to_high = box.max()[axis] - x[axis];
    if (gravity[axis] == 0.0) {
      if (to_low > 0.0 || to_high < 0.0) return false;
      continue;
    }
    from = std::max(from, std::min(to_low / gravity[axis], to_high / gravity[axis]));
    to = std::min(to, std::max(to_low / gravity[axis], to_high / gravity[axis]));
  }
  return from <= to;
}

template <int Dim>
bool is_passing_end(const Flow<Dim>& flow, const Vec<Dim>& x) {
  return std::any_of(flow.setup.open_ends.begin(), flow.setup.open_ends.end(),
                     [&](const OpenEnd<Dim>& end) { return end.opening.is_passed_by(x); });
}

}  // namespace

Water& Water::operator+=(const Water& other) {
  particles += other.particles;
  volume += other.volume;
  return *this;
}

Water& Water::operator-=(const Water& other) {
  particles -= other.particles;
  volume -= other.volume;
  return *this;
}

std::string Water::text() const { return fmt::format("{} particles ({:.6g} m^3)", particles, volume); }

template <int Dim>
Water water_in(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Water water = sum_over(particles.owned, Water(), [&](std::size_t i) {
    return particles.is_fluid(i) ? Water{1, particles.volume[i]} : Water();
  });
  flow.setup.ranks.sum_each(water.particles, water.volume);
  return water;
}

template <int Dim>
Water water_outside(const Flow<Dim>& flow) {
  const Eigen::AlignedBox<double, Dim> box = box_around(flow);
  if (box.isEmpty()) return {};
  const Particles<Dim>& particles = flow.state.particles;
  Water water = sum_over(particles.owned, Water(), [&](std::size_t i) {
    const Vec<Dim>& x = particles.position[i];
    const bool is_outside =
        particles.is_fluid(i) && !falls_into(box, x, flow.setup.gravity) && !is_passing_end(flow, x);
    return is_outside ? Water{1, particles.volume[i]} : Water();
  });
  flow.setup.ranks.sum_each(water.particles, water.volume);
  return water;
}

template <int Dim>
Water water_out(const Flow<Dim>& flow) {
  Water water;
  for (const OpenEndState& end : flow.state.open_ends) water += {end.departed.particles, end.departed.volume};
  return water;
}

template <int Dim>
Water water_came(const Flow<Dim>& flow) {
  Water water;
  for (const OpenEndState& end : flow.state.open_ends) water += {end.arrived.particles, end.arrived.volume};
  return water;
}

template <int Dim>
nlohmann::ordered_json water_balance(const Water& at_start, const Flow<Dim>& flow) {
  const double density = flow.setup.density;
  const auto json_of_passed = [&](const Passed& passed) {
    nlohmann::ordered_json json = json_of({passed.particles, passed.volume}, density);
    json["energy_J"] = passed.energy;
    return json;
  };
  nlohmann::ordered_json inlets = nlohmann::ordered_json::array();
  nlohmann::ordered_json outlets = nlohmann::ordered_json::array();
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const Opening<Dim>& opening = flow.setup.open_ends[e].opening;
    const OpenEndState& end = flow.state.open_ends[e];
    const bool is_inlet = opening.kind == OpeningKind::inlet;
    // On the way that is meant, and `back`.
    nlohmann::ordered_json json;
    json["name"] = opening.name;
    json.update(json_of_passed(is_inlet ? end.arrived : end.departed));
    json["back"] = json_of_passed(is_inlet ? end.departed : end.arrived);
    const int circuit = flow.setup.open_ends[e].circuit;
    if (circuit >= 0 && is_inlet) json["steps_short_of_water"] = end.short_steps;
    if (circuit == static_cast<int>(e)) {
      const Passed sump = sump_of(flow, circuit);
      json["waiting"] = json_of(Water{sump.particles, sump.volume}, density);
    }
    (is_inlet ? inlets : outlets).push_back(json);
  }
  const Water outside = water_outside(flow);
  Water inside = water_in(flow);
  inside -= outside;
  return {{"start", json_of(at_start, density)},
          {"in", json_of(water_came(flow), density)},
          {"inside", json_of(inside, density)},
          {"outside", json_of(outside, density)},
          {"out", json_of(water_out(flow), density)},
          {"inlets", inlets},
          {"outlets", outlets}};
}

template <int Dim>
std::size_t count_outside(const Flow<Dim>& flow) {
  const Eigen::AlignedBox<double, Dim> box = box_around(flow);
  if (box.isEmpty()) return 0;
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t count = count_each(particles.owned, [&](std::size_t i) {
    const Vec<Dim>& x = particles.position[i];
    return particles.is_fluid(i) && !box.contains(x) && !is_passing_end(flow, x);
  });
  return flow.setup.ranks.sum(count);
}

#define TAILWATER_INSTANTIATE(Dim)                                                    \
  template Water water_in<Dim>(const Flow<Dim>&);                                     \
  template Water water_outside<Dim>(const Flow<Dim>&);                                \
  template Water water_out<Dim>(const Flow<Dim>&);                                    \
  template Water water_came<Dim>(const Flow<Dim>&);                                   \
  template nlohmann::ordered_json water_balance<Dim>(const Water&, const Flow<Dim>&); \
  template std::size_t count_outside<Dim>(const Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
