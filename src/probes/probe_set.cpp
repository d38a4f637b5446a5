#include "probes/probe_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/assert.h"
#include "base/for_each.h"
#include "case/rheology.h"
#include "parallel/together.h"
#include "probes/body_motion.h"
#include "probes/discharge.h"
#include "probes/front.h"
#include "probes/gather.h"
#include "probes/level_map.h"
#include "probes/places.h"
#include "probes/point.h"
#include "probes/pressure_map.h"
#include "probes/run_up.h"
#include "probes/velocity_profile.h"
#include "probes/wall_force.h"
#include "probes/wall_pressure.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

template <int Dim>
Reading<Dim> energy_reading(const ProbeTable& probe) {
  return {columns_of(probe, Dim), [](const ProbeContext<Dim>& context) -> std::vector<Row> {
            const FlowTotals& totals = context.totals;
            return {{totals.kinetic_energy, totals.potential_energy, totals.kinetic_energy + totals.potential_energy}};
          }};
}

template <int Dim>
Reading<Dim> volume_reading(const ProbeTable& probe) {
  return {columns_of(probe, Dim), [](const ProbeContext<Dim>& context) -> std::vector<Row> {
            const Particles<Dim>& particles = context.particles;
            const std::size_t count = count_each(particles.owned, [&](std::size_t i) {
              return particles.is_fluid(i) && !context.boundary.is_in_duct(particles.position[i]);
            });
            return {{context.ranks.sum(static_cast<double>(count)), context.totals.density_error_mean,
                     context.totals.density_error_rms, context.totals.volume_out, context.totals.volume_in}};
          }};
}

template <int Dim>
Reading<Dim> pockets_reading(const ProbeTable& probe, const CaseSpec& spec) {
  if (spec.air.pockets == AirPockets::none) {
    throw CaseError("probe-needs-air", {"{} reads enclosed air, which this case does not compute", label(probe)},
                    {"give pockets = \"{}\" in [air], or remove the probe", name_of(AirPockets::adiabatic)});
  }
  return {columns_of(probe, Dim), [](const ProbeContext<Dim>& context) -> std::vector<Row> {
            const PocketTotals& air = context.totals.air;
            return {{air.pressure, air.volume, air.gas, air.vented, air.energy, air.pockets}};
          }};
}

template <int Dim>
Reading<Dim> make_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  switch (probe.type) {
    case ProbeType::depth:
      return depth_reading(probe, spec, boundary);
    case ProbeType::wall_pressure:
      return wall_pressure_reading(probe, spec, boundary);
    case ProbeType::wall_pressure_mean:
      return wall_pressure_mean_reading(probe, spec, boundary);
    case ProbeType::front:
      return front_reading<Dim>(probe);
    case ProbeType::profile:
      return profile_reading(probe, spec, boundary);
    case ProbeType::pressure:
      return pressure_reading<Dim>(probe);
    case ProbeType::velocity:
      return velocity_reading<Dim>(probe, spec);
    case ProbeType::energy:
      return energy_reading<Dim>(probe);
    case ProbeType::discharge:
      return discharge_reading<Dim>(probe, spec);
    case ProbeType::force:
      return force_reading(probe, spec, boundary);
    case ProbeType::pressure_map:
      return pressure_map_reading(probe, spec, boundary);
    case ProbeType::motion:
      return motion_reading<Dim>(probe, spec);
    case ProbeType::run_up:
      return run_up_reading(probe, spec, boundary);
    case ProbeType::level_map:
      return level_map_reading(probe, spec, boundary);
    case ProbeType::velocity_profile:
      return velocity_profile_reading(probe, spec, boundary);
    case ProbeType::pockets:
      return pockets_reading<Dim>(probe, spec);
    case ProbeType::volume:
      break;
  }
  return volume_reading<Dim>(probe);
}

/// Lets a reading measure only the liquid that its table names.
template <int Dim>
Reading<Dim> reading_of_liquid(const ProbeTable& probe, const CaseSpec& spec, Reading<Dim> reading) {
  if (probe.liquid.empty() || !has_several_liquids(spec)) return reading;
  reading.take = [take = std::move(reading.take),
                  liquid = index_of_liquid(spec, probe.liquid)](const ProbeContext<Dim>& context) {
    ProbeContext<Dim> of_liquid = context;
    of_liquid.liquid = liquid;
    return take(of_liquid);
  };
  return reading;
}

}  // namespace

template <int Dim>
std::vector<Probe<Dim>> make_probes(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<Probe<Dim>> probes;
  for (const ProbeTable& table : spec.probes) {
    Probe<Dim> probe{table.name, table.type, reading_of_liquid(table, spec, make_reading(table, spec, boundary)),
                     table.interval, table.times};
    std::sort(probe.times.begin(), probe.times.end());
    probes.push_back(std::move(probe));
  }
  return probes;
}

template <int Dim>
ProbeSet<Dim>::ProbeSet(std::vector<Probe<Dim>> probes, const RunFolder& folder, const Communicator& ranks,
                        const std::optional<std::vector<ProbeMark>>& marks) {
  for (std::size_t k = 0; k < probes.size(); ++k) {
    instruments_.push_back({std::move(probes[k]), std::nullopt, marks ? marks->at(k).taken : 0});
  }
  do_on_root(ranks, [&] {
    for (std::size_t k = 0; k < instruments_.size(); ++k) {
      Instrument& instrument = instruments_[k];
      const Probe<Dim>& probe = instrument.probe;
      std::vector<std::string> headings{"time_s"};
      for (const OutputColumn& column : probe.reading.columns) headings.push_back(column.heading);
      instrument.csv.emplace(folder.probe(probe.name), headings,
                             marks ? std::optional(marks->at(k).size) : std::nullopt);
    }
  });
}

template <int Dim>
std::vector<ProbeMark> ProbeSet<Dim>::marks() const {
  std::vector<ProbeMark> marks;
  for (const Instrument& instrument : instruments_) {
    marks.push_back({instrument.taken, instrument.csv ? instrument.csv->size() : 0});
  }
  return marks;
}

template <int Dim>
std::vector<double> ProbeSet<Dim>::memory() const {
  std::vector<double> all;
  for (const Instrument& instrument : instruments_) {
    const auto& own = instrument.probe.reading.memory;
    if (!own) continue;
    all.push_back(static_cast<double>(own->size()));
    all.insert(all.end(), own->begin(), own->end());
  }
  return all;
}

template <int Dim>
void ProbeSet<Dim>::restore(std::span<const double> memory, const std::filesystem::path& checkpoints) {
  const auto require = [&](bool fits) {
    if (fits) return;
    throw IoError(
        "the probe data of the checkpoint do not belong to these probes; remedy: remove the newest file in '{}', to "
        "continue from the one before",
        checkpoints.string());
  };
  for (const Instrument& instrument : instruments_) {
    const Reading<Dim>& reading = instrument.probe.reading;
    if (!reading.memory) continue;
    const auto needed = static_cast<double>(reading.memory->size());
    require(!memory.empty() && memory[0] <= static_cast<double>(memory.size() - 1) &&
            (memory[0] == needed || (reading.memory_grows && memory[0] >= needed)));
    const auto size = static_cast<std::size_t>(memory[0]);
    const std::span<const double> own = memory.subspan(1, size);
    reading.memory->assign(own.begin(), own.end());
    memory = memory.subspan(1 + size);
  }
  require(memory.empty());
}

template <int Dim>
std::vector<typename ProbeSet<Dim>::Summary> ProbeSet<Dim>::summaries() const {
  std::vector<Summary> all;
  for (const Instrument& instrument : instruments_) {
    const Probe<Dim>& probe = instrument.probe;
    if (!probe.reading.totals) continue;
    const std::vector<OutputColumn> declared = totals_of(probe.type, Dim);
    const std::vector<double> values = probe.reading.totals();
    TAILWATER_ASSERT(values.size() <= declared.size(), "a probe has the totals that its type declares");
    Summary summary{probe.name, {}};
    for (std::size_t k = 0; k < values.size(); ++k) summary.lines.emplace_back(declared[k].heading, values[k]);
    all.push_back(std::move(summary));
  }
  return all;
}

template <int Dim>
void ProbeSet<Dim>::write_maps(const RunFolder& folder, double time, const Communicator& ranks) const {
  do_on_root(ranks, [&] {
    for (const Instrument& instrument : instruments_) {
      const Probe<Dim>& probe = instrument.probe;
      if (probe.reading.write_map) probe.reading.write_map(folder.probe_map(probe.name), time);
    }
  });
}

template <int Dim>
bool ProbeSet<Dim>::Instrument::is_due(double time) const {
  if (!probe.times.empty()) return taken < probe.times.size() && probe.times[taken] <= time;
  return static_cast<double>(taken) * probe.interval <= time;
}

template <int Dim>
bool ProbeSet<Dim>::is_due(double time) const {
  return std::any_of(instruments_.begin(), instruments_.end(),
                     [time](const Instrument& instrument) { return instrument.is_read(time); });
}

template <int Dim>
void ProbeSet<Dim>::Instrument::write(double time, const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    Row line{time};
    line.insert(line.end(), row.begin(), row.end());
    csv->write(line);
  }
}

template <int Dim>
void ProbeSet<Dim>::Instrument::count_as_taken(double time) {
  if (!is_due(time) || (probe.times.empty() && probe.interval == 0.0)) return;  // the latter is due at every step
  // A long step may pass many intervals. The quotient may be off by one, for round-off.
  if (probe.times.empty()) taken = std::max(taken, static_cast<std::size_t>(time / probe.interval));
  while (is_due(time)) ++taken;
}

template <int Dim>
void ProbeSet<Dim>::record(const ProbeContext<Dim>& context) {
  const Communicator& ranks = context.ranks;
  std::vector<Instrument*> read;
  std::vector<Region<Dim>> regions;
  for (Instrument& instrument : instruments_) {
    if (!instrument.is_read(context.time)) continue;
    read.push_back(&instrument);
    if (instrument.probe.reading.region) regions.push_back(instrument.probe.reading.region(context.time));
  }
  GatheredParticles<Dim> gathered;
  if (!ranks.is_alone() && !regions.empty()) gathered = gather_near(context, regions);
  const CellGrid<Dim> grid(gathered.particles.position, kernel_radius(context.kernel));
  ProbeContext<Dim> near = context.of(gathered.particles, grid);
  near.felt_through = gathered.felt_through;
  const WallInertia<Dim> inertia_near = gathered.wall_inertia();
  if (context.wall_inertia != nullptr) near.wall_inertia = &inertia_near;

  std::vector<std::vector<Row>> rows;
  for (const Instrument* instrument : read) {
    const Reading<Dim>& reading = instrument->probe.reading;
    const bool is_local = ranks.is_alone() || !reading.region;
    rows.push_back(is_local || ranks.is_root() ? reading.take(is_local ? context : near) : std::vector<Row>());
  }
  do_on_root(ranks, [&] {
    for (std::size_t k = 0; k < read.size(); ++k) {
      if (read[k]->is_due(context.time)) read[k]->write(context.time, rows[k]);
    }
  });
  for (Instrument* instrument : read) instrument->count_as_taken(context.time);
}

TAILWATER_IN_2D_AND_3D(make_probes);
template class ProbeSet<2>;
template class ProbeSet<3>;

}  // namespace tailwater
