#include "parts/domain_floor.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/box.h"
#include "base/for_each.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "flow/measure.h"

namespace tailwater {
namespace {

/// A place along gravity below which nothing can bring water back: a support below all walls and open ends, and the
/// edges of a periodic domain.
template <int Dim>
struct Floor {
  Vec<Dim> down = Vec<Dim>::Zero();  ///< of length 1; zero: there is no floor
  double depth = 0.0;                ///< m; along `down`

  bool is_passed_by(const Vec<Dim>& x) const { return down.dot(x) > depth; }
};

template <int Dim>
Floor<Dim> find_floor(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  Box<Dim> box = flow.box();
  if (box.isEmpty()) return {};
  for (int d = 0; d < Dim; ++d) {
    if (!setup.domain[d]) continue;
    box.min()[d] = std::min(box.min()[d], setup.domain[d]->first);
    box.max()[d] = std::max(box.max()[d], setup.domain[d]->second);
  }
  const Vec<Dim> down = setup.gravity.normalized();
  const Vec<Dim> lowest = Vec<Dim>::NullaryExpr([&](int d) { return down[d] > 0.0 ? box.max()[d] : box.min()[d]; });
  return {down, down.dot(lowest) + kernel_radius(setup.scale.kernel)};
}

}  // namespace

template <int Dim>
Json DomainFloor<Dim>::save() const {
  return fallen_;
}

template <int Dim>
bool DomainFloor<Dim>::restore(const Json& saved) {
  saved.get_to(fallen_);
  return true;
}

template <int Dim>
void DomainFloor<Dim>::take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves) {
  const Particles<Dim>& particles = flow.state.particles;
  const Floor<Dim> floor = find_floor(flow);
  const std::vector<std::size_t> fallen = indices_where(particles.owned, [&](std::size_t i) {
    return particles.is_fluid(i) && leaves[i] == 0 && floor.is_passed_by(particles.position[i]);
  });
  if (!flow.setup.ranks.any(!fallen.empty())) return;
  fallen_ += amount_of<Dim>(flow, fallen);
  for (const std::size_t i : fallen) leaves[i] = 1;
}

template <int Dim>
void DomainFloor<Dim>::add_passed_water(WaterAmount& departed, WaterAmount& /*arrived*/) const {
  departed += fallen_;
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_domain_floor(const CaseSpec& /*spec*/, const Setup<Dim>& setup,
                                             const Boundary<Dim>& /*boundary*/) {
  if (setup.gravity.norm() == 0.0) return nullptr;
  return std::make_unique<DomainFloor<Dim>>();
}

template class DomainFloor<2>;
template class DomainFloor<3>;
TAILWATER_IN_2D_AND_3D(make_domain_floor);

}  // namespace tailwater
