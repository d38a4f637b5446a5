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
  throw InputError("{}: body = \"{}\": there is no such body; {}", label(probe), probe.body,
                   unknown_name_hint(probe.body, names));
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
  const auto add_columns = [&](const std::string& what, int count, const std::string& unit) {
    for (int k = 0; k < count; ++k) {
      const std::string axis = count == 1 ? "" : std::string("_") + "xyz"[k];
      reading.columns.push_back(what + axis + "_" + unit);
    }
  };
  add_columns("displacement", Dim, "m");
  add_columns("angle", turns<Dim>, "rad");
  add_columns("velocity", Dim, "m_per_s");
  add_columns("angular_velocity", turns<Dim>, "rad_per_s");

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
  reading.summary = [memory, columns = reading.columns] {
    std::vector<std::pair<std::string, double>> lines;
    for (std::size_t k = 0; k < places<Dim>; ++k) {
      lines.emplace_back("least_" + columns[k], (*memory)[k]);
      lines.emplace_back("largest_" + columns[k], (*memory)[k + places<Dim>]);
    }
    return lines;
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(motion_reading);

}  // namespace tailwater
