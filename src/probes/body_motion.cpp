#include "probes/body_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

/// Displacements and angles.
template <int Dim>
constexpr std::size_t places = Dim + turns<Dim>;

/// The angle of a rotation, times its axis, with as many whole turns that it is nearest to `last`, so that the angle of
/// a body that rolls on does not jump. All in rad.
template <int Dim>
Turn<Dim> angle_near(const Turn<Dim>& last, const Mat<Dim>& rotation) {
  constexpr double whole_turn = 2.0 * std::numbers::pi;
  const Turn<Dim> angle = angle_of<Dim>(rotation);
  const Turn<Dim> axis = angle.norm() > 0.0 ? Turn<Dim>(angle.normalized()) : Turn<Dim>(last.normalized());
  return angle + whole_turn * std::round((last.dot(axis) - angle.dot(axis)) / whole_turn) * axis;
}

}  // namespace

template <int Dim>
Reading<Dim> motion_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const std::size_t number = number_of_body(probe, spec);
  const Vec<Dim> drawn = make_bodies<Dim>(spec)[number].drawn.centre;
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  constexpr double infinity = std::numeric_limits<double>::max();
  // Kept by a checkpoint: the least and the largest of the places so far, then the last angle.
  const auto memory = std::make_shared<std::vector<double>>(2 * places<Dim> + turns<Dim>);
  std::fill_n(memory->begin(), places<Dim>, infinity);
  std::fill_n(memory->begin() + places<Dim>, places<Dim>, -infinity);
  reading.take = [=](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const BodyState<Dim>& body = context.bodies[number];
    Row row;
    const auto add = [&](const auto& numbers) { row.insert(row.end(), numbers.begin(), numbers.end()); };
    add(Vec<Dim>(body.centre - drawn));
    const auto kept = memory->begin() + 2 * places<Dim>;
    Turn<Dim> last;
    std::copy_n(kept, turns<Dim>, last.begin());
    const Turn<Dim> angle = angle_near<Dim>(last, body.placement.linear);
    std::copy_n(angle.begin(), turns<Dim>, kept);
    add(angle);
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
