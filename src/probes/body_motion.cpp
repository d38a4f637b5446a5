#include "probes/body_motion.h"

#include <algorithm>
#include <limits>

#include "case/nearest_name.h"
#include "probes/places.h"

namespace tailwater {
namespace {

/// Index into CaseSpec::bodies.
std::size_t number_of_body(const ProbeTable& probe, const CaseSpec& spec) {
  const auto body = std::ranges::find(spec.bodies, probe.body, &BodyTable::name);
  if (body != spec.bodies.end()) return static_cast<std::size_t>(body - spec.bodies.begin());
  std::vector<std::string_view> names;
  for (const BodyTable& table : spec.bodies) names.push_back(table.name);
  throw CaseError("probe-body-unknown",
                  {"{} = \"{}\": there is no such body", label(probe).with_key("body"), probe.body},
                  {"{}", unknown_name_hint(probe.body, names)});
}

/// Least and largest of the displacements and angles so far, as numbers that a checkpoint keeps.
template <int Dim>
constexpr std::size_t places = Dim + turns<Dim>;

}  // namespace

template <int Dim>
Reading<Dim> motion_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const std::size_t number = number_of_body(probe, spec);
  const Vec<Dim> drawn = make_bodies<Dim>(spec)[number].drawn.centre;
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  constexpr double infinity = std::numeric_limits<double>::max();
  const auto memory = std::make_shared<std::vector<double>>(2 * places<Dim>);
  std::fill_n(memory->begin(), places<Dim>, infinity);
  std::fill_n(memory->begin() + places<Dim>, places<Dim>, -infinity);
  reading.take = [=](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const BodyState<Dim>& body = context.bodies[number];
    Row row;
    const auto add = [&](const auto& numbers) { row.insert(row.end(), numbers.begin(), numbers.end()); };
    add(Vec<Dim>(body.centre - drawn));
    add(angle_of<Dim>(body.placement.linear));
    add(body.velocity);
    for (std::size_t k = 0; k < places<Dim>; ++k) {
      double& least = (*memory)[k];
      double& largest = (*memory)[k + places<Dim>];
      least = std::min(least, row[k]);
      largest = std::max(largest, row[k]);
    }
    return {row};
  };
  reading.memory = memory;
  reading.totals = [memory] {
    std::vector<double> totals;
    for (std::size_t k = 0; k < places<Dim>; ++k) {
      totals.insert(totals.end(), {(*memory)[k], (*memory)[k + places<Dim>]});
    }
    return totals;
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(motion_reading);

}  // namespace tailwater
