#include "results/unresolved.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "case/probe_columns.h"
#include "motion/wave_maker.h"
#include "results/probe_table.h"

namespace tailwater {
namespace {

/// dx; a surface that moves less is considered at rest: the water's edge on a beach moves by 0.32 dx before any wave.
constexpr double min_motion = 0.4;

/// Probes with a height each, of which the largest is reported.
struct Gauges {
  std::vector<std::string> names;
  double largest = 0.0;  ///< m
  double rows = 0.0;     ///< the largest of them over the spacing at its probe

  void add(const std::string& name, double height, double spacing) {
    names.push_back(fmt::format("'{}'", name));
    largest = std::max(largest, height);
    rows = std::max(rows, height / spacing);
  }
  double spacing_to_resolve() const { return 0.99 * largest / lowest_resolved_wave; }  ///< m
  std::string text() const {
    return fmt::format("{} {}", names.size() == 1 ? "probe" : "probes", fmt::join(names, ", "));
  }
};

/// The column "connected" of a probe of depth or run-up; without numbers if it has none.
ColumnDigest connected_surface(const ProbeTable& probe, const CaseSpec& spec, const RunFolder& folder) {
  const std::vector<OutputColumn> columns = columns_of(probe, spec.general.dimension);
  const auto column = std::ranges::find(columns, std::string_view("connected"), &OutputColumn::name);
  if (column == columns.end()) return {};
  const TableDigest table = digest_probe_table(folder.probe(probe.name), 0.0);
  const auto place = std::ranges::find(table.names, column->heading);
  return place == table.names.end() ? ColumnDigest() : table.columns[place - table.names.begin()];
}

/// m; the largest spacing at the places that a probe names.
template <int Dim>
double coarsest_at(const Setup<Dim>& setup, const ProbeTable& probe) {
  double relative = 0.0;
  for (const Coordinates& at : {probe.at, probe.from, probe.to}) {
    if (at.size() == Dim) relative = std::max(relative, setup.relative_spacing(Vec<Dim>::Map(at.data())));
  }
  return setup.scale.spacing * (relative > 0.0 ? relative : 1.0);
}

}  // namespace

template <int Dim>
Findings unresolved_surfaces(const CaseSpec& spec, const RunFolder& folder, const Setup<Dim>& setup) {
  const auto makes_waves = [](const WaveKeys& waves) { return waves.waves != WaveKind::none; };
  const bool has_waves =
      std::ranges::any_of(spec.wave_makers, makes_waves) || std::ranges::any_of(spec.damping, makes_waves);
  Gauges waves, films;
  for (const ProbeTable& probe : spec.probes) {
    if (probe.type != ProbeType::depth && probe.type != ProbeType::run_up) continue;
    const ColumnDigest surface = connected_surface(probe, spec, folder);
    if (surface.count == 0) continue;
    const double motion = surface.largest - surface.least;
    const double dx = coarsest_at(setup, probe);
    const double lowest = lowest_resolved_wave * dx;
    if (probe.type == ProbeType::depth && surface.largest > 0.0 && surface.largest < lowest) {
      films.add(probe.name, surface.largest, dx);
    } else if (has_waves && motion > min_motion * dx && motion < lowest) {
      waves.add(probe.name, motion, dx);
    }
  }
  Findings findings;
  if (!waves.names.empty()) {
    findings.push_back(Finding::warning("waves-not-resolved",
                                        {"at {} the surface moved by {:.3g} m or less, {:.2g} spacings: waves of less "
                                         "than {:g} spacings are not resolved",
                                         waves.text(), waves.largest, waves.rows, lowest_resolved_wave},
                                        {"use a spacing of at most {:.3g} m", waves.spacing_to_resolve()}));
  }
  if (!films.names.empty()) {
    findings.push_back(Finding::warning("films-not-resolved",
                                        {"at {} the largest depth was {:.3g} m or less, {:.2g} spacings: films of less "
                                         "than {:g} spacings are not resolved",
                                         films.text(), films.largest, films.rows, lowest_resolved_wave},
                                        {"use a spacing of at most {:.3g} m", films.spacing_to_resolve()}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(unresolved_surfaces);

}  // namespace tailwater
