#include "results/field_output.h"

#include <algorithm>

#include "base/for_each.h"
#include "closures/spalart_allmaras.h"
#include "rheology/thick_liquid.h"

namespace tailwater {

template <int Dim>
FluidFields<Dim>::FluidFields(const Flow<Dim>& flow, const Particles<Dim>& particles,
                              const std::vector<std::string>& names)
    : names_(names) {
  const auto add_name = [&](bool is_needed, const char* name) {
    if (is_needed && std::ranges::count(names_, name) == 0) names_.emplace_back(name);
  };
  add_name(flow.setup.graded != nullptr, "volume");
  add_name(flow.setup.liquids.are_several(), "liquid");
  std::vector<std::size_t> fluid = indices_where(particles.owned, [&](std::size_t i) { return particles.is_fluid(i); });
  std::sort(fluid.begin(), fluid.end(),
            [&](std::size_t a, std::size_t b) { return particles.id[a] < particles.id[b]; });
  // Before the first step there are no work fields: the start is a lattice without marks.
  const bool has_work_fields = !flow.surroundings.concentration.empty();
  const auto& thick = flow.template part<ThickLiquid<Dim>>();
  const auto make_room = [&](auto&... field) { (field.reserve(fluid.size()), ...); };
  make_room(position_, velocity_, pressure_, density_error_, is_surface_, eddy_viscosity_, shear_rate_, viscosity_,
            liquid_, density_, volume_, id_);
  for (const std::size_t i : fluid) {
    position_.push_back(particles.position[i]);
    velocity_.push_back(particles.velocity[i]);
    pressure_.push_back(particles.pressure[i]);
    density_error_.push_back(has_work_fields ? flow.surroundings.concentration[i] - 1.0 : 0.0);
    is_surface_.push_back(has_work_fields ? flow.surroundings.is_surface[i] : 0);
    eddy_viscosity_.push_back(
        spalart_allmaras::eddy_viscosity(particles.layer_viscosity[i], flow.setup.liquid.viscosity.molecular));
    shear_rate_.push_back(thick.shear_rate(i));
    viscosity_.push_back(thick.viscosity(i));
    liquid_.push_back(flow.setup.liquids.of(particles.id[i]));
    density_.push_back(flow.setup.liquids.are_several() ? flow.setup.liquids.density[liquid_.back()]
                                                        : flow.setup.liquid.density);
    volume_.push_back(particles.volume[i]);
    id_.push_back(particles.id[i]);
  }
}

template <int Dim>
ParticleFields<Dim> FluidFields<Dim>::view() const {
  ParticleFields<Dim> result{.position = position_, .fields = {}};
  for (const std::string& name : names_) {
    if (name == "pressure") result.fields.push_back({name, pressure_});
    if (name == "velocity") result.fields.push_back({name, velocity_});
    if (name == "density_error") result.fields.push_back({name, density_error_});
    if (name == "is_free_surface") result.fields.push_back({name, is_surface_});
    if (name == "eddy_viscosity") result.fields.push_back({name, eddy_viscosity_});
    if (name == "shear_rate") result.fields.push_back({name, shear_rate_});
    if (name == "viscosity") result.fields.push_back({name, viscosity_});
    if (name == "liquid") result.fields.push_back({name, liquid_});
    if (name == "density") result.fields.push_back({name, density_});
    if (name == "volume") result.fields.push_back({name, volume_});
    if (name == "id") result.fields.push_back({name, id_});
  }
  return result;
}

template <int Dim>
WallFields<Dim>::WallFields(const Boundary<Dim>& boundary) {
  corner_.reserve(Dim * boundary.faces.size());
  wall_.reserve(Dim * boundary.faces.size());
  for (const WallFace<Dim>& face : boundary.faces) {
    corner_.insert(corner_.end(), face.corners.begin(), face.corners.end());
    wall_.insert(wall_.end(), Dim, face.wall);
  }
}

template <int Dim>
ParticleFields<Dim> WallFields<Dim>::view() const {
  return {.position = corner_, .fields = {{"wall", wall_}}, .corners = Dim};
}

template class FluidFields<2>;
template class FluidFields<3>;
template class WallFields<2>;
template class WallFields<3>;

}  // namespace tailwater
