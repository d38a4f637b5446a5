#include "motion/floating_body.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// Entries of a Twist, by the names of the case file.
template <int Dim>
int entry_of(std::string_view degree) {
  constexpr std::array<std::string_view, 3> in_plane{"x", "y", "rotation"};
  constexpr std::array<std::string_view, 6> in_space{"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
  if constexpr (Dim == 2) {
    return static_cast<int>(std::ranges::find(in_plane, degree) - in_plane.begin());
  } else {
    return static_cast<int>(std::ranges::find(in_space, degree) - in_space.begin());
  }
}

/// Index of the body of that name, or -1.
int body_named(const CaseSpec& spec, const std::string& name) {
  const auto body = std::ranges::find(spec.bodies, name, &BodyTable::name);
  return body == spec.bodies.end() ? -1 : static_cast<int>(body - spec.bodies.begin());
}

/// Zeros where no numbers are given.
template <int Dim>
Twist<Dim> to_twist(const std::vector<double>& numbers) {
  Twist<Dim> twist = Twist<Dim>::Zero();
  for (std::size_t k = 0; k < numbers.size(); ++k) twist[static_cast<int>(k)] = numbers[k];
  return twist;
}

}  // namespace

// A body is exactly where its walls were placed, to the last bit, because a resumed run places them from the state.
template <int Dim>
AffineMap<Dim> BodyState<Dim>::at(double t) const {
  if (t == time) return placement;
  const Mat<Dim> turn = rotation_by<Dim>((t - time) * angular_velocity());
  AffineMap<Dim> there;
  there.linear = rotation_by<Dim>(angle_of<Dim>(turn * placement.linear));  // products of rotations drift by rounding
  there.constant = turn * (placement.constant - centre) + centre_at(t);
  return there;
}

template <int Dim>
void BodyState<Dim>::go_on(double t) {
  placement = at(t);
  centre = centre_at(t);
  time = t;
}

template <int Dim>
FloatingBody<Dim>::FloatingBody(const CaseSpec& spec, const BodyTable& table)
    : name(table.name),
      mass(table.mass),
      inertia(Turn<Dim>::Ones()),
      springs(to_twist<Dim>(table.springs)),
      linear_damping(to_twist<Dim>(table.damping)),
      quadratic_damping(to_twist<Dim>(table.quadratic_damping)),
      extra_mass(to_twist<Dim>(table.extra_mass)) {
  const CaseLabel owner("body", name);
  for (std::size_t k = 0; k < table.inertia.size(); ++k) inertia[static_cast<int>(k)] = table.inertia[k];
  for (const std::string& degree : table.free) free.push_back(entry_of<Dim>(degree));
  std::ranges::sort(free);
  free.erase(std::unique(free.begin(), free.end()), free.end());
  drawn.centre = to_vec<Dim>(table.centre, owner, "centre");
  drawn.velocity.put(0, to_vec<Dim>(table.velocity, owner, "velocity"));
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (std::ranges::find(table.walls, spec.walls[w].name) != table.walls.end()) walls.push_back(static_cast<int>(w));
  }
}

template <int Dim>
Mat<Dim == 2 ? 1 : 3> FloatingBody<Dim>::inertia_of(const BodyState<Dim>& state) const {
  if constexpr (Dim == 2) {
    return inertia;
  } else {
    return state.placement.linear * inertia.asDiagonal() * state.placement.linear.transpose();
  }
}

template <int Dim>
Twist<Dim> FloatingBody<Dim>::force_of(const BodyState<Dim>& state, const Twist<Dim>& acceleration) const {
  return twist_of<Dim>(mass * acceleration.template head<Dim>(),
                       inertia_of(state) * acceleration.template tail<turns<Dim>>()) +
         extra_mass.cwiseProduct(acceleration);
}

template <int Dim>
Twist<Dim> FloatingBody<Dim>::scale() const {
  return twist_of<Dim>(Vec<Dim>::Constant(mass), Turn<Dim>::Constant(inertia.mean())) + extra_mass;
}

template <int Dim>
Twist<Dim> FloatingBody<Dim>::damping(const BodyState<Dim>& state) const {
  return linear_damping + quadratic_damping.cwiseProduct(state.velocity.cwiseAbs());
}

template <int Dim>
Twist<Dim> FloatingBody<Dim>::load(const BodyState<Dim>& state, const Vec<Dim>& gravity) const {
  Twist<Dim> load = Twist<Dim>::Zero();
  load.put(0, mass * gravity);
  if constexpr (Dim == 3) {
    const Vec<3> omega = state.angular_velocity();
    load.put(3, -omega.cross(inertia_of(state) * omega));
  }
  const Twist<Dim> displacement = twist_of<Dim>(state.centre - drawn.centre, angle_of<Dim>(state.placement.linear));
  load -= springs.cwiseProduct(displacement) + damping(state).cwiseProduct(state.velocity);
  return load;
}

template <int Dim>
std::vector<FloatingBody<Dim>> make_bodies(const CaseSpec& spec) {
  std::vector<FloatingBody<Dim>> bodies;
  for (const BodyTable& table : spec.bodies) bodies.emplace_back(spec, table);
  return bodies;
}

template <int Dim>
std::vector<Mooring<Dim>> make_moorings(const CaseSpec& spec) {
  std::vector<Mooring<Dim>> moorings;
  for (const MooringTable& table : spec.moorings) {
    const CaseLabel owner("mooring", table.name);
    moorings.push_back({.body = body_named(spec, table.bodies.front()),
                        .to_body = table.bodies.size() > 1 ? body_named(spec, table.bodies.back()) : -1,
                        .at = to_vec<Dim>(table.at, owner, "at"),
                        .anchor = to_vec<Dim>(table.anchor, owner, "anchor"),
                        .stiffness = table.stiffness,
                        .length = table.length,
                        .damping = table.damping});
  }
  return moorings;
}

namespace {

/// Speed that a unit impulse gives the place x of a body as drawn, at most [1/kg].
template <int Dim>
double mobility_at(const FloatingBody<Dim>& body, const Vec<Dim>& x) {
  const auto is_turn = [](int entry) { return entry >= Dim; };
  const bool turns_at_all = std::ranges::any_of(body.free, is_turn);
  const bool goes = !std::ranges::all_of(body.free, is_turn);
  return (goes ? 1.0 / body.mass : 0.0) +
         (turns_at_all ? (x - body.drawn.centre).squaredNorm() / body.inertia.minCoeff() : 0.0);
}

}  // namespace

template <int Dim>
double frequency_of(const Mooring<Dim>& mooring, const std::vector<FloatingBody<Dim>>& bodies) {
  double mobility = mobility_at<Dim>(bodies[mooring.body], mooring.at);
  if (mooring.to_body >= 0) mobility += mobility_at<Dim>(bodies[mooring.to_body], mooring.anchor);
  return std::sqrt(mooring.stiffness * mobility);
}

template double frequency_of<2>(const Mooring<2>&, const std::vector<FloatingBody<2>>&);
template double frequency_of<3>(const Mooring<3>&, const std::vector<FloatingBody<3>>&);
template struct BodyState<2>;
template struct BodyState<3>;
template struct FloatingBody<2>;
template struct FloatingBody<3>;
TAILWATER_IN_2D_AND_3D(make_bodies);
TAILWATER_IN_2D_AND_3D(make_moorings);

}  // namespace tailwater
