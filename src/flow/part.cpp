#include "flow/part.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/box.h"

namespace tailwater {

void StepLimits::include(const StepLimits& other) {
  speed = std::max(speed, other.speed);
  viscosity += other.viscosity;
  step = std::min(step, other.step);
}

template <int Dim>
void Part<Dim>::extend_box(Box<Dim>& /*box*/) const {}

template <int Dim>
void Part<Dim>::begin(Flow<Dim>& /*flow*/) {}

template <int Dim>
Json Part<Dim>::save() const {
  return nullptr;
}

template <int Dim>
bool Part<Dim>::restore(const Json& /*saved*/) {
  return true;
}

template <int Dim>
void Part<Dim>::adapt(Flow<Dim>& /*flow*/) {}

template <int Dim>
void Part<Dim>::follow_moved_water(const Flow<Dim>& /*flow*/, std::span<const MovedWater<Dim>> /*moved*/) {}

template <int Dim>
void Part<Dim>::take_out(const Flow<Dim>& /*flow*/, std::span<std::uint8_t> /*leaves*/) {}

template <int Dim>
bool Part<Dim>::bring_in(Flow<Dim>& /*flow*/) {
  return false;
}

template <int Dim>
void Part<Dim>::reordered(Reordering /*how*/) {}

template <int Dim>
StepLimits Part<Dim>::step_limits(const Flow<Dim>& /*flow*/) const {
  return {};
}

template <int Dim>
double Part<Dim>::lowest_unbalanced(const Flow<Dim>& /*flow*/, const Vec<Dim>& /*down*/) const {
  return std::numeric_limits<double>::lowest();
}

template <int Dim>
void Part<Dim>::claim(const Flow<Dim>& /*flow*/, std::span<Role> /*role*/) {}

template <int Dim>
void Part<Dim>::begin_step(Flow<Dim>& /*flow*/, double /*dt*/) {}

template <int Dim>
void Part<Dim>::add_viscosity(const Flow<Dim>& /*flow*/, std::span<double> /*viscosity*/) const {}

template <int Dim>
void Part<Dim>::follow_friction(Flow<Dim>& /*flow*/, std::span<const FrictionWall<Dim>> /*walls*/,
                                std::span<const Mat<Dim>> /*velocity_gradient*/, double /*dt*/) {}

template <int Dim>
void Part<Dim>::add_relaxation(const Flow<Dim>& /*flow*/, const StepStart<Dim>& /*start*/,
                               std::vector<Vec<Dim>>& /*drive*/) const {}

template <int Dim>
void Part<Dim>::add_damping_rate(const Flow<Dim>& /*flow*/, const StepStart<Dim>& /*start*/,
                                 std::vector<double>& /*rate*/) const {}

template <int Dim>
void Part<Dim>::add_acceleration(const Flow<Dim>& /*flow*/, std::span<Vec<Dim>> /*acceleration*/) const {}

template <int Dim>
void Part<Dim>::arrive(Flow<Dim>& /*flow*/) {}

template <int Dim>
void Part<Dim>::begin_projection(Flow<Dim>& /*flow*/, Projection /*projection*/, double /*dt*/) {}

template <int Dim>
void Part<Dim>::change_prediction(const Flow<Dim>& /*flow*/, std::span<const Vec<Dim>> /*acceleration*/, double /*dt*/,
                                  std::span<Vec<Dim>> /*predicted*/) {}

template <int Dim>
void Part<Dim>::change_target(const Flow<Dim>& /*flow*/, std::span<const Mat<Dim>> /*velocity_gradient*/, double /*dt*/,
                              std::span<double> /*target*/) const {}

template <int Dim>
void Part<Dim>::write_rows(Flow<Dim>& /*flow*/) {}

template <int Dim>
int Part<Dim>::pose(Flow<Dim>& /*flow*/, std::span<const Vec<Dim>> /*predicted*/, double /*dt*/) {
  return 0;
}

template <int Dim>
void Part<Dim>::add_allowed_tension(const Flow<Dim>& /*flow*/, std::vector<double>& /*tension*/) const {}

template <int Dim>
std::unique_ptr<CoupledUnknowns> Part<Dim>::couple(Flow<Dim>& /*flow*/, const PosedEquation& /*equation*/,
                                                   WallDrive<Dim>& /*drive*/) {
  return nullptr;
}

template <int Dim>
void Part<Dim>::see_tension(const Flow<Dim>& /*flow*/, std::span<const double> /*pressure*/,
                            const std::vector<double>& /*allowed*/) {}

template <int Dim>
void Part<Dim>::finish_solve(Flow<Dim>& /*flow*/, double /*dt*/) {}

template <int Dim>
bool Part<Dim>::add_pressure(std::span<double> /*pressure*/) const {
  return false;
}

template <int Dim>
void Part<Dim>::subtract_pressure(std::span<double> /*pressure*/) const {}

template <int Dim>
void Part<Dim>::correct(Flow<Dim>& /*flow*/, double /*dt*/) {}

template <int Dim>
void Part<Dim>::subtract_from_walls(const Flow<Dim>& /*flow*/, std::vector<double>& /*pressure*/) const {}

template <int Dim>
void Part<Dim>::add_work(const Flow<Dim>& /*flow*/, const std::vector<double>& /*on_walls*/, double /*dt*/,
                         Works& /*works*/) const {}

template <int Dim>
void Part<Dim>::project_again(Flow<Dim>& /*flow*/, const std::vector<double>& /*correction*/, double /*dt*/) {}

template <int Dim>
void Part<Dim>::stay(Flow<Dim>& /*flow*/) {}

template <int Dim>
void Part<Dim>::finish_step(Flow<Dim>& /*flow*/, const StepStart<Dim>& /*start*/, double /*dt*/) {}

template <int Dim>
std::vector<StepColumn> Part<Dim>::step_columns() const {
  return {};
}

template <int Dim>
void Part<Dim>::add_to_summary(const Flow<Dim>& /*flow*/, Json& /*summary*/) const {}

template <int Dim>
void Part<Dim>::add_passed_water(WaterAmount& /*departed*/, WaterAmount& /*arrived*/) const {}

template <int Dim>
void Part<Dim>::warn(const Flow<Dim>& /*flow*/) {}

template <int Dim>
void Part<Dim>::warn_at_end(const Flow<Dim>& /*flow*/) const {}

template class Part<2>;
template class Part<3>;

}  // namespace tailwater
