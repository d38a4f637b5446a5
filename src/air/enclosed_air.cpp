#include "air/enclosed_air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "air/contact_lines.h"
#include "air/pocket_pressure.h"
#include "air/space_of_run.h"
#include "base/finding.h"
#include "base/for_each.h"
#include "base/saved.h"
#include "flow/measure.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "motion/wall_motion.h"

namespace tailwater {

// There may be many runs of cells, so they are saved without names.
inline void to_json(Json& json, const CellRun& run) { json = {run.row, run.begin, run.end}; }
inline void from_json(const Json& json, CellRun& run) { run = {json.at(0), json.at(1), json.at(2)}; }
TAILWATER_SAVED(inline, AirPocket, number, gas, volume, torn, cells)
TAILWATER_SAVED(inline, AirState, pockets, hidden, brought, begun, ended, displacement, gas_found, gas_lost,
                gas_handed_on, gas_vented, energy_lost, energy_vented, energy_set)

namespace {

/// Rows of water whose weight a pressure below 0 may hold before a warning.
constexpr double min_rows_of_tension = 2.0;

/// The grid to which saved cells belong: the place of its first cell, and the number of cells along the second axis.
template <int Dim>
Json save_grid(const VoidGrid<Dim>& grid) {
  const Vec<Dim> first = grid.centre({});
  return {{"first", std::vector<double>(first.begin(), first.end())}, {"count", grid.count(1)}};
}

/// Moves runs of cells by `shift` cells, from a grid with `count` cells along the second axis. A run that is resumed
/// may have another end, and walls that go farther. Parts outside of the grid are left out.
template <int Dim>
std::vector<CellRun> in_grid(const VoidGrid<Dim>& grid, const std::array<std::int64_t, Dim>& shift, int count,
                             const std::vector<CellRun>& runs) {
  std::vector<CellRun> moved;
  for (const CellRun& run : runs) {
    typename VoidGrid<Dim>::Cell cell{};
    bool is_inside = true;
    for (int d = 0; d < Dim - 1; ++d) {
      const int former = Dim == 2 ? run.row : d == 0 ? run.row / count : run.row % count;
      const std::int64_t now = former + shift[d];
      is_inside = is_inside && now >= 0 && now < grid.count(d);
      if (is_inside) cell[d] = static_cast<int>(now);
    }
    const std::int64_t begin = std::max<std::int64_t>(0, run.begin + shift[Dim - 1]);
    const std::int64_t end = std::min<std::int64_t>(grid.length(), run.end + shift[Dim - 1]);
    if (!is_inside || begin >= end) continue;
    moved.push_back({grid.row_of(cell), static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end)});
  }
  return moved;
}

/// Moves the cells of all pockets from the grid that save_grid has saved. Returns false if no grid can have these
/// numbers.
template <int Dim>
bool move_cells(const Json& saved, const VoidGrid<Dim>& grid, AirState& state) {
  constexpr double max_shift = 1e9;  // cells
  const auto first = saved.at("first").get<std::vector<double>>();
  const auto count = saved.at("count").get<std::int64_t>();
  if (first.size() != Dim || count <= 0 || count > std::numeric_limits<int>::max()) return false;
  std::array<std::int64_t, Dim> shift;
  for (int d = 0; d < Dim; ++d) {
    const double offset = first[d] - grid.centre({})[d];
    if (!(std::abs(offset) < max_shift * grid.edge()[d])) return false;
    shift[d] = std::lround(offset / grid.edge()[d]);
  }
  for (std::vector<AirPocket>* pockets : {&state.pockets, &state.hidden}) {
    for (AirPocket& pocket : *pockets) pocket.cells = in_grid<Dim>(grid, shift, static_cast<int>(count), pocket.cells);
  }
  return true;
}

template <int Dim>
std::vector<VentPlace<Dim>> make_vents(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<VentPlace<Dim>> vents;
  for (const VentTable& vent : spec.vents) {
    const Vec<Dim> at = to_vec<Dim>(vent.at, CaseLabel("vent", vent.name), "at");
    const NearestWall<Dim> wall = boundary.nearest(at, 0.5 * spec.particles.spacing);
    vents.push_back({at, wall.face < 0 ? -1 : boundary.faces[wall.face].wall});
  }
  return vents;
}

}  // namespace

template <int Dim>
EnclosedAir<Dim>::EnclosedAir(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary)
    : watch(spec, boundary.ducts, box_of_run(spec, setup, boundary), setup.domain),
      vents_(make_vents(spec, boundary)),
      starts_at_pressure_(!spec.pockets.empty()) {}

template <int Dim>
std::function<double(const Vec<Dim>&)> EnclosedAir<Dim>::pressure_field(const Boundary<Dim>& boundary) const {
  if (state.pockets.empty()) return {};
  return [this, &boundary](const Vec<Dim>& x) {
    double sum = 0.0;
    for (const PocketShare& share : watch.shares_at(boundary, x))
      sum += share.share * pressure_of(state.pockets[share.pocket]);
    return sum;
  };
}

template <int Dim>
AirMeasures EnclosedAir<Dim>::measures() const {
  AirMeasures air{.pockets = state.pockets.size()};
  double largest = 0.0;
  for (const AirPocket& pocket : state.pockets) {
    air.volume += pocket.volume;
    air.gas += pocket.gas;
    air.energy += watch.law().energy(pocket.gas, pocket.volume);
    if (pocket.volume <= largest) continue;
    largest = pocket.volume;
    air.pressure = pressure_of(pocket);
  }
  return air;
}

/// Throws InputError where the case gives air a pressure and there is no enclosed air, before a run writes anything.
/// Warns of air at a pressure too far below 0 for water that is also open to other air.
template <int Dim>
void EnclosedAir<Dim>::begin(Flow<Dim>& flow) {
  if (!starts_at_pressure_) return;
  AirState first;
  watch.look(flow.walls, {}, flow.state.particles, flow.setup.ranks, first);
  const double least =
      -min_rows_of_tension * flow.setup.liquid.density * flow.setup.gravity.norm() * flow.setup.scale.spacing;
  for (int k = 0; k < static_cast<int>(first.pockets.size()); ++k) {
    const double pressure = pressure_of(first.pockets[k]);
    if (pressure >= least || watch.reference_of(k) == k) continue;
    const Finding finding = Finding::warning(
        "air-pressure-separates-water",
        {"air enclosed at the start has a pressure of {:.4g} relative to the atmosphere, and the water beside it is "
         "open to other air; this water will separate or be stirred, because the model sustains no tension there",
         Amount{pressure, "Pa"}},
        {"separate this water from other air, or give the enclosed air an overpressure of at least 0"});
    tailwater::warn(finding);
  }
  watch.forget();
}

template <int Dim>
Json EnclosedAir<Dim>::save() const {
  Json saved = state;
  if (watch.is_on()) saved["grid"] = save_grid(watch.grid());
  return saved;
}

template <int Dim>
bool EnclosedAir<Dim>::restore(const Json& saved) {
  saved.get_to(state);
  if (watch.is_on() && saved.contains("grid") && !move_cells(saved.at("grid"), watch.grid(), state)) return false;
  const auto is_sound = [](const AirPocket& p) { return p.gas >= 0.0 && p.volume > 0.0; };
  return std::ranges::all_of(state.pockets, is_sound) && std::ranges::all_of(state.hidden, is_sound);
}

template <int Dim>
void EnclosedAir<Dim>::reordered(Reordering how) {
  if (how == Reordering::sorted) {
    watch.forget();
  } else {
    watch.forget_responses();
  }
}

/// Present places of vents [m]: a vent on a moving wall moves with it.
template <int Dim>
std::vector<Vec<Dim>> EnclosedAir<Dim>::places_of_vents(const Flow<Dim>& flow) const {
  std::vector<Vec<Dim>> places;
  for (const VentPlace<Dim>& vent : vents_) {
    places.push_back(vent.at);
    for (const auto& moving : flow.setup.wall_motion->moving()) {
      if (moving.wall == vent.wall) places.back() = moving.at(flow.state.time, flow.state.motion)(vent.at);
    }
  }
  return places;
}

/// Searches for pockets if water may have gone far since the last search.
template <int Dim>
void EnclosedAir<Dim>::begin_step(Flow<Dim>& flow, double /*dt*/) {
  if (!watch.is_due(state)) return;
  watch.look(flow.walls, places_of_vents(flow), flow.state.particles, flow.setup.ranks, state);
}

template <int Dim>
int EnclosedAir<Dim>::pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) {
  step = pose_pockets(flow, *this, predicted, dt);
  if (!state.pockets.empty()) find_inflow(flow, *this, dt);
  return step.iterations;
}

template <int Dim>
void EnclosedAir<Dim>::add_allowed_tension(const Flow<Dim>& flow, std::vector<double>& tension) const {
  if (state.pockets.empty()) return;
  tension.resize(flow.state.particles.size(), 0.0);
  for_each(flow.state.particles.owned, [&](std::size_t i) { tension[i] += step.response_deficit[i]; });
  flow.halo().exchange(tension);
}

template <int Dim>
void EnclosedAir<Dim>::finish_solve(Flow<Dim>& flow, double dt) {
  std::vector<double>& air = watch.air_pressure();
  air.clear();
  if (state.pockets.empty()) return;
  step.pressure = find_air_pressures(flow, *this, dt);
  air.assign(flow.state.particles.size(), 0.0);
  add_air_of<Dim>(*this, step.pressure, air);
}

template <int Dim>
bool EnclosedAir<Dim>::add_pressure(std::span<double> pressure) const {
  const std::vector<double>& air = watch.air_pressure();
  for_each(std::min(air.size(), pressure.size()), [&](std::size_t i) { pressure[i] += air[i]; });
  return !state.pockets.empty();
}

template <int Dim>
void EnclosedAir<Dim>::subtract_pressure(std::span<double> pressure) const {
  const std::vector<double>& air = watch.air_pressure();
  for_each(std::min(air.size(), pressure.size()), [&](std::size_t i) { pressure[i] -= air[i]; });
}

template <int Dim>
void EnclosedAir<Dim>::stay(Flow<Dim>& flow) {
  remove_push_along_walls(flow, step);
}

template <int Dim>
void EnclosedAir<Dim>::correct(Flow<Dim>& flow, double dt) {
  push_by_pockets(flow, *this, dt);
  remove_push_along_walls(flow, step);
  state.brought = brought_by_ends(flow);
  count_displacement(flow, dt);
}

/// Counts how far water and walls go in a step of dt with their present velocity. Water and walls beside pockets count
/// in full, all others by a quarter: a search for new pockets is needed only when these may have gone four times as
/// far.
template <int Dim>
void EnclosedAir<Dim>::count_displacement(const Flow<Dim>& flow, double dt) {
  const double time = flow.state.time;
  const double walls = flow.setup.wall_motion->largest_displacement(time, time + dt, flow.state.motion);
  const double anywhere = std::max(dt * flow.setup.time_step_rule.limiting_speed(largest_speed(flow)), walls);
  double beside = 0.0;
  if (!state.pockets.empty()) {
    const std::vector<Vec<Dim>>& velocity = flow.state.particles.velocity;
    const double speed = largest_over(step.water.size(), 0.0, [&](std::size_t n) {
      return step.water[n].is_beside ? velocity[step.water[n].particle].norm() : 0.0;
    });
    beside = std::max(dt * flow.setup.ranks.largest(speed), walls);
  }
  state.displacement += std::max(beside, 0.25 * anywhere);
}

template <int Dim>
void EnclosedAir<Dim>::subtract_from_walls(const Flow<Dim>& flow, std::vector<double>& pressure) const {
  if (!step.pressure.empty()) subtract_seen_air<Dim>(flow, *this, step.pressure, pressure);
}

template <int Dim>
void EnclosedAir<Dim>::add_work(const Flow<Dim>& flow, const std::vector<double>& /*on_walls*/, double dt,
                                Works& works) const {
  if (!flow.setup.ranks.is_root() || step.pressure.empty()) return;
  works.air += step.work;
  const std::vector<double> growth = growth_at_walls(flow, *this, dt);
  for (std::size_t k = 0; k < step.pressure.size(); ++k) {
    works.walls -= dt * step.pressure[k] * growth[k];
    // The work of the pairs is counted already.
    works.ends -= dt * step.pressure[k] * (step.inflow[k] - step.inflow_of_pairs[k]);
  }
}

template <int Dim>
std::vector<StepColumn> EnclosedAir<Dim>::step_columns() const {
  const AirMeasures air = measures();
  return {{"air_work_J", step.work},
          {"air_energy_J", air.energy},
          {"pockets", static_cast<double>(air.pockets)},
          {"pockets_volume_m3", air.volume},
          {"pocket_pressure_Pa", air.pressure}};
}

template <int Dim>
void EnclosedAir<Dim>::add_to_summary(const Flow<Dim>& /*flow*/, Json& summary) const {
  Json now = Json::array();
  for (const AirPocket& pocket : state.pockets) {
    now.push_back({{"number", pocket.number},
                   {"volume_m3", pocket.volume},
                   {"gas_m3", pocket.gas},
                   {"pressure_Pa", pressure_of(pocket)}});
  }
  double hidden = 0.0;
  for (const AirPocket& pocket : state.hidden) hidden += pocket.gas;
  summary["pockets"] = {{"begun", state.begun},
                        {"ended", state.ended},
                        {"gas_found_m3", state.gas_found},
                        {"gas_lost_m3", state.gas_lost},
                        {"gas_handed_on_m3", state.gas_handed_on},
                        {"gas_hidden_m3", hidden},
                        {"gas_vented_m3", state.gas_vented},
                        {"energy_J", measures().energy},
                        {"energy_lost_J", state.energy_lost},
                        {"energy_vented_J", state.energy_vented},
                        {"energy_set_J", state.energy_set},
                        {"now", std::move(now)}};
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_enclosed_air(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary) {
  if (spec.air.pockets == AirPockets::none) return nullptr;
  return std::make_unique<EnclosedAir<Dim>>(spec, setup, boundary);
}

template class EnclosedAir<2>;
template class EnclosedAir<3>;
TAILWATER_IN_2D_AND_3D(make_enclosed_air);

}  // namespace tailwater
