#include "probes/velocity_profile.h"

#include <memory>

#include "probes/places.h"
#include "probes/point.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

/// Sums over the time between readings; a checkpoint saves these numbers.
enum ProfileSum { time_of_last_reading, duration, depth_integral, velocity_integral };

template <int Dim>
std::vector<Row> read_profile(const ProbeContext<Dim>& context, const UprightGauge<Dim>& gauge, double step,
                              std::vector<double>& memory) {
  const UprightLine<Dim> line = gauge.now(context);
  const WaterColumn column = WaterColumns<Dim>(context).on(line);
  Vec<Dim> flux = Vec<Dim>::Zero();
  std::vector<Row> rows;
  const int pieces = column.connected > 0.0 ? pieces_of_at_most(step, column.connected) : 0;
  for (int k = 0; k < pieces; ++k) {
    const double low = k * step;
    const double high = k + 1 < pieces ? low + step : column.connected;
    const double height = 0.5 * (low + high);
    const Vec<Dim> u = velocity_at<Dim>(context, line.foot + (column.bed + height) * line.up);
    flux += (high - low) * u;
    rows.push_back({height});
    rows.back().insert(rows.back().end(), u.begin(), u.end());
  }
  const Vec<Dim> mean = pieces > 0 ? Vec<Dim>(flux / column.connected) : flux;
  if (rows.empty()) rows.emplace_back(1 + Dim, 0.0);
  for (Row& row : rows) {
    row.push_back(column.connected);
    row.insert(row.end(), mean.begin(), mean.end());
  }
  const double since_last = context.time - memory[time_of_last_reading];
  memory[time_of_last_reading] = context.time;
  memory[duration] += since_last;
  memory[depth_integral] += since_last * column.connected;
  for (int d = 0; d < Dim; ++d) memory[velocity_integral + d] += since_last * mean[d];
  return rows;
}

}  // namespace

template <int Dim>
Reading<Dim> velocity_profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  const UprightGauge<Dim> gauge(probe, at, spec, boundary);
  const double step = step_of(probe, spec.particles.spacing);
  const auto memory = std::make_shared<std::vector<double>>(velocity_integral + Dim, 0.0);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.take = [gauge, step, memory](const ProbeContext<Dim>& context) {
    return read_profile(context, gauge, step, *memory);
  };
  reading.region = [gauge](double time) { return gauge.region(time); };
  reading.memory = memory;
  reading.totals = [memory] {
    const double time = (*memory)[duration] > 0.0 ? (*memory)[duration] : 1.0;
    std::vector<double> totals(memory->begin() + depth_integral, memory->end());
    for (double& total : totals) total /= time;
    return totals;
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(velocity_profile_reading);

}  // namespace tailwater
