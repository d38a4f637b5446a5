#include "open_ends/open_ends.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/box.h"
#include "base/error.h"
#include "base/for_each.h"
#include "base/saved.h"
#include "case/formulation.h"
#include "closures/fluid_pairs.h"
#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/pores.h"
#include "flow/pressure_equation.h"
#include "operators/graded_sums.h"
#include "operators/support_operators.h"

namespace tailwater {

TAILWATER_SAVED(inline, LevelError, mean, lasts, since, total, most)
TAILWATER_SAVED(inline, LeavingWave, height, number, swing, swing_rate)
TAILWATER_SAVED(inline, OpenEndState, is_wet, wet_time, speed, delayed_speed, acceleration, mean_speed, mean_discharge,
                invariant, surface, depth, level, is_full, depth_rate, entry_speed, fibre_speeds, stretching, rows,
                wave, miss, asked, asked_total, filling, departed, arrived, short_steps)

namespace {

/// By how much, since when and for how long a prescribed level was missed; null: it was held.
Json json_of_miss(const LevelError& miss) {
  if (miss.since < 0.0) return nullptr;
  return {{"by_m", miss.most}, {"since_s", miss.since}, {"for_s", miss.total}};
}

Json json_of_passed(const WaterAmount& passed) {
  Json json = summary_of(passed);
  json["energy_J"] = passed.energy;
  return json;
}

/// m; from an opening to the farthest corner of a wall inside, along its normal.
template <int Dim>
double reach_of(const Opening<Dim>& opening, const Boundary<Dim>& boundary) {
  const double at_end = opening.normal.dot(opening.corner);
  double reach = 0.0;
  for (const WallFace<Dim>& face : boundary.faces) {
    for (const Vec<Dim>& corner : face.corners) reach = std::max(reach, at_end - opening.normal.dot(corner));
  }
  return reach;
}

}  // namespace

template <int Dim>
bool OpenEnds<Dim>::is_passed_by(const Vec<Dim>& x) const {
  return std::ranges::any_of(ends_, [&](const OpenEnd<Dim>& end) { return end.is_passed_by(x); });
}

template <int Dim>
WaterAmount OpenEnds<Dim>::departed() const {
  WaterAmount water;
  for (const OpenEndState& state : states_) water += state.departed;
  return water;
}

template <int Dim>
WaterAmount OpenEnds<Dim>::arrived() const {
  WaterAmount water;
  for (const OpenEndState& state : states_) water += state.arrived;
  return water;
}

template <int Dim>
WaterAmount OpenEnds<Dim>::sump(int circuit, double density) const {
  WaterAmount sump;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (ends_[e].circuit != circuit) continue;
    const double particle = power<Dim>(ends_[e].spacing);
    const std::int64_t reserve = std::lround(ends_[e].reserve / particle);
    const double volume = static_cast<double>(reserve) * particle;
    sump += {reserve, volume, density * volume};
    sump += states_[e].departed;
    sump -= states_[e].arrived;
  }
  return sump;
}

template <int Dim>
Json OpenEnds<Dim>::balance(OpeningKind kind, double density) const {
  Json of_each = Json::array();
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const OpenEnd<Dim>& end = ends_[e];
    const OpenEndState& state = states_[e];
    if (end.opening.kind != kind) continue;
    const bool is_inlet = kind == OpeningKind::inlet;
    // In the intended direction, and `back`.
    Json json;
    json["name"] = end.opening.name;
    const Json in = json_of_passed(state.arrived);
    const Json out = json_of_passed(state.departed);
    json.update(is_inlet ? in : out);
    json["back"] = is_inlet ? out : in;
    if (end.circuit >= 0 && is_inlet) json["steps_short_of_water"] = state.short_steps;
    if (end.flow.feeds()) {
      json["asked_for_m3"] = state.asked;
      json["filled_duct_m3"] = state.filling;
    }
    if (end.holds_level()) json["level_missed"] = json_of_miss(state.miss);
    if (end.circuit == static_cast<int>(e)) json["waiting"] = summary_of(sump(end.circuit, density));
    of_each.push_back(json);
  }
  return of_each;
}

template <int Dim>
void OpenEnds<Dim>::set_discharge(const std::string& inlet, double time, double discharge) {
  const auto end =
      std::ranges::find_if(ends_, [&](const OpenEnd<Dim>& candidate) { return candidate.opening.name == inlet; });
  if (end == ends_.end()) throw InputError("there is no inlet '{}'", inlet);
  if (!end->flow.discharge) {
    throw InputError("{} has no discharge that a script can change; remedy: give it one in the case",
                     end->opening.label());
  }
  end->flow.discharge = TimeFunction(SmoothCurve({time}, {discharge}));
}

template <int Dim>
void OpenEnds<Dim>::extend_box(Box<Dim>& box) const {
  for (const OpenEnd<Dim>& end : ends_) {
    box.extend(box_around(end.opening.as_faces()));
    if (!end.air()) continue;
    for (const Vec<Dim>& x : end.mouth.rim()) {
      box.extend(x - Vec<Dim>::Constant(end.far_out));
      box.extend(x + Vec<Dim>::Constant(end.far_out));
    }
  }
}

template <int Dim>
void OpenEnds<Dim>::begin(Flow<Dim>& flow) {
  liquids_.resize(ends_.size());
  if (!flow.setup.liquids.are_several()) return;
  for (std::size_t e = 0; e < ends_.size(); ++e) liquids_[e] = LiquidsBeyond(ends_[e], flow);
}

template <int Dim>
Json OpenEnds<Dim>::save() const {
  return {{"states", states_}, {"warnings", warnings_}};
}

template <int Dim>
bool OpenEnds<Dim>::restore(const Json& saved) {
  saved.at("states").get_to(states_);
  saved.at("warnings").get_to(warnings_);
  return states_.size() == ends_.size();
}

template <int Dim>
void OpenEnds<Dim>::take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<std::vector<std::size_t>> left_by(ends_.size());
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    left_by[e] = indices_where(particles.owned, [&](std::size_t i) {
      return particles.is_fluid(i) && leaves[i] == 0 && ends_[e].is_passed_by(particles.position[i]);
    });
    for (const std::size_t i : left_by[e]) leaves[i] = 1;
  }
  const bool some_leave = std::ranges::any_of(left_by, [](const auto& water) { return !water.empty(); });
  if (!flow.setup.ranks.any(some_leave)) return;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    states_[e].departed += amount_of<Dim>(flow, left_by[e]);
  }
}

template <int Dim>
StepLimits OpenEnds<Dim>::step_limits(const Flow<Dim>& flow) const {
  StepLimits limits;
  for (const OpenEnd<Dim>& end : ends_) {
    if (end.is_driven()) limits.speed = std::max(limits.speed, end.largest_speed(flow.state.time, end.spacing));
  }
  return limits;
}

template <int Dim>
void OpenEnds<Dim>::claim(const Flow<Dim>& flow, std::span<Role> role) {
  const Particles<Dim>& particles = flow.state.particles;
  end_of_.assign(particles.owned, -1);
  for_each(particles.owned, [&](std::size_t i) {
    for (std::size_t e = 0; particles.is_fluid(i) && e < ends_.size(); ++e) {
      if (!ends_[e].holds(particles.position[i])) continue;
      role[i] = ends_[e].flow.feeds() ? Role::following : Role::prescribed;
      end_of_[i] = static_cast<std::int16_t>(e);
    }
  });
}

template <int Dim>
void OpenEnds<Dim>::write_rows(Flow<Dim>& flow) {
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (end_of_[i] >= 0) write_row(flow, i);
  });
}

/// Where the velocity is prescribed, the pressure is that of the water inside, as behind a wall; elsewhere, and as long
/// as there is no water inside, it is hydrostatic.
template <int Dim>
void OpenEnds<Dim>::write_row(Flow<Dim>& flow, std::size_t i) const {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const OpenEnd<Dim>& end = ends_[end_of_[i]];
  const Vec<Dim>& x = particles.position[i];
  const Vec<Dim>& velocity = particles.velocity[i];  // the filter velocity, within a projection
  const Vec<Dim> slowing = deceleration(flow.pores, x, velocity);
  const auto weight = [&](std::size_t k) {
    const auto j = pairs.j[k];
    return particles.is_fluid(j) && !end.holds(particles.position[j]) ? particles.volume[j] * pairs.value(i, k) : 0.0;
  };
  double total = 0.0;
  for (std::size_t k = pairs.begin(i); flow.role[i] == Role::following && k < pairs.end(i); ++k) total += weight(k);
  LinearSystem::Row row = flow.equation->rows.row(i);
  if (total == 0.0) {
    row.set_weights([](std::size_t) { return 0.0; });
    const auto e = static_cast<std::size_t>(end_of_[i]);
    row.finish(1.0,
               end.pressure_at(states_[e], x, velocity, slowing, density_above(flow, end, states_[e], liquids_[e], x)));
    return;
  }
  const double density = flow.density_of(i);
  const Vec<Dim> force = setup.gravity - slowing;
  double hydrostatic = 0.0;
  const double sum = row.set_weights([&](std::size_t k) {
    const double share = weight(k) / total;
    hydrostatic += share * density * force.dot(pairs.d(i, k));
    return share;
  });
  row.finish(sum, hydrostatic);
}

template <int Dim>
void OpenEnds<Dim>::add_work(const Flow<Dim>& flow, const std::vector<double>& /*on_walls*/, double dt,
                             Works& works) const {
  if (std::ranges::none_of(ends_, [](const OpenEnd<Dim>& end) { return end.is_driven(); })) return;
  works.ends += driven_change_ + sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
                  return is_driven(i) ? work_of_driven_particle(flow, i, dt) : 0.0;
                });
}

/// Work [J] of the prescribed water in a buffer on the water that is solved for, as of a wall, and the work done on the
/// prescribed water itself.
template <int Dim>
double OpenEnds<Dim>::work_of_driven_particle(const Flow<Dim>& flow, std::size_t i, double dt) const {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const OpenEnd<Dim>& end = ends_[end_of_[i]];
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const Vec<Dim> recoil = sum_over_fluid<Dim>(pairs, particles, i, [&](std::size_t j, std::size_t k) {
    if (end.holds(particles.position[j])) return Vec<Dim>(Vec<Dim>::Zero());
    const double sum =
        inverse_reference(terms, i) * particles.pressure[i] + inverse_reference(terms, j) * particles.pressure[j];
    return Vec<Dim>((particles.volume[j] * sum) * flow.surroundings.pair_vectors.at(pairs, i, k));
  });
  const Vec<Dim> weight = flow.density_of(i) * flow.setup.gravity;
  return dt * flow.water_volume_of(i) * (recoil - weight).dot(particles.velocity[i]);
}

template <int Dim>
void OpenEnds<Dim>::add_passed_water(WaterAmount& departed, WaterAmount& arrived) const {
  departed += this->departed();
  arrived += this->arrived();
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_open_ends_part(const CaseSpec& spec, const Setup<Dim>& setup,
                                               const Boundary<Dim>& boundary) {
  std::vector<OpenEnd<Dim>> ends;
  const SpacingField<Dim> field = setup.graded == nullptr ? SpacingField<Dim>() : setup.graded->field();
  for (ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec, boundary.ducts, field)) {
    const double spacing = setup.scale.spacing * setup.relative_spacing(box_around(end.opening.as_faces()).center());
    ends.emplace_back(std::move(end), setup.gravity, spacing, traits_of(spec).support * spacing);
    ends.back().reach = reach_of(ends.back().opening, boundary);
  }
  if (ends.empty()) return nullptr;
  return std::make_unique<OpenEnds<Dim>>(std::move(ends));
}

template class OpenEnds<2>;
template class OpenEnds<3>;
TAILWATER_IN_2D_AND_3D(make_open_ends_part);

}  // namespace tailwater
