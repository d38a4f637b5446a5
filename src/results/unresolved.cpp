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
  const auto add = [&](const Gauges& gauges, std::string_view what, std::string_view thing) {
    if (gauges.names.empty()) return;
    findings.push_back(
        Finding::warning("surface-not-resolved",
                         {"at {} {} {:.3g} m or less, {:.2g} spacings: {} of less than {:g} spacings are not resolved",
                          gauges.text(), what, gauges.largest, gauges.rows, thing, lowest_resolved_wave},
                         {"use a spacing of at most {:.3g} m", 0.99 * gauges.largest / lowest_resolved_wave}));
  };
  add(waves, "the surface moved by", "waves");
  add(films, "the largest depth was", "films");
  return findings;
}

TAILWATER_IN_2D_AND_3D(unresolved_surfaces);

}  // namespace tailwater
