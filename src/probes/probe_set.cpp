#include "probes/probe_set.h"

#include <algorithm>
#include <utility>

#include "probes/front.h"
#include "probes/point.h"
#include "probes/wall_pressure.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

template <int Dim>
Reading<Dim> energy_reading() {
  return {{"kinetic_J", "potential_J", "total_J"}, [](const ProbeContext<Dim>& context) -> std::vector<Row> {
            const FlowTotals& totals = context.totals;
            return {{totals.kinetic_energy, totals.potential_energy, totals.kinetic_energy + totals.potential_energy}};
          }};
}

template <int Dim>
Reading<Dim> volume_reading() {
  return {{"particles", "density_error_mean", "density_error_rms", "volume_out_m3"},
          [](const ProbeContext<Dim>& context) -> std::vector<Row> {
            const Particles<Dim>& particles = context.particles;
            const auto count =
                std::count(particles.kind.begin(),
                           particles.kind.begin() + static_cast<std::ptrdiff_t>(particles.owned), ParticleKind::fluid);
            return {{static_cast<double>(count), context.totals.density_error_mean, context.totals.density_error_rms,
                     context.totals.volume_out}};
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
      return velocity_reading<Dim>(probe);
    case ProbeType::energy:
      return energy_reading<Dim>();
    case ProbeType::volume:
      break;
  }
  return volume_reading<Dim>();
}

}  // namespace

template <int Dim>
std::vector<Probe<Dim>> make_probes(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<Probe<Dim>> probes;
  for (const ProbeTable& table : spec.probes) {
    Probe<Dim> probe{table.name, make_reading(table, spec, boundary), table.interval, table.times};
    std::sort(probe.times.begin(), probe.times.end());
    probes.push_back(std::move(probe));
  }
  return probes;
}

template <int Dim>
ProbeSet<Dim>::ProbeSet(std::vector<Probe<Dim>> probes, const RunFolder& folder) {
  for (Probe<Dim>& probe : probes) {
    std::vector<std::string> columns{"time_s"};
    columns.insert(columns.end(), probe.reading.columns.begin(), probe.reading.columns.end());
    CsvWriter csv(folder.probe(probe.name), columns);
    instruments_.push_back({std::move(probe), std::move(csv)});
  }
}

template <int Dim>
bool ProbeSet<Dim>::Instrument::is_due(double time) const {
  if (!probe.times.empty()) return taken < probe.times.size() && probe.times[taken] <= time;
  return static_cast<double>(taken) * probe.interval <= time;
}

template <int Dim>
bool ProbeSet<Dim>::is_due(double time) const {
  return std::any_of(instruments_.begin(), instruments_.end(),
                     [time](const Instrument& instrument) { return instrument.is_due(time); });
}

template <int Dim>
void ProbeSet<Dim>::record(const ProbeContext<Dim>& context) {
  for (Instrument& instrument : instruments_) {
    if (!instrument.is_due(context.time)) continue;
    for (Row& row : instrument.probe.reading.take(context)) {
      row.insert(row.begin(), context.time);
      instrument.csv.write(row);
    }
    if (instrument.probe.times.empty() && instrument.probe.interval == 0.0) continue;  // due at every step
    // A long step may pass more than one.
    while (instrument.is_due(context.time)) ++instrument.taken;
  }
}

template std::vector<Probe<2>> make_probes<2>(const CaseSpec&, const Boundary<2>&);
template std::vector<Probe<3>> make_probes<3>(const CaseSpec&, const Boundary<3>&);
template class ProbeSet<2>;
template class ProbeSet<3>;

}  // namespace tailwater
