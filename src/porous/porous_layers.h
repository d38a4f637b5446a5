// Water in porous layers, a part of a flow. A particle moves with the velocity u of the water in the pores. It keeps
// its volume w of water and occupies the volume V = w/n of the layer, which is Particles::volume: all sums over
// particles fill space with V, as in open water. Per mass of water in the pores
//
//   (1 + c_A) Du/Dt = -grad p/rho + g + viscous terms - r u,      div (n u) = 0
//
// With the resistance at the end of the step and the mobility m = 1/(1 + c_A + r dt), the filter velocity v = n u is
//
//   v' = k [(1 + c_A) u + dt a] + dt k (g - grad p/rho),        k = n m, the conductance
//
// varies. Within a projection the velocity of particles is v. Equations and their discrete form: docs/theory/porous.md.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flow/part.h"
#include "flow/pores.h"
#include "porous/porous_field.h"
#include "porous/porous_region.h"

namespace tailwater {

template <int Dim>
class PorousLayers final : public Part<Dim>, public Pores<Dim> {
 public:
  PorousLayers() = default;
  PorousLayers(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary);

  std::string_view name() const override { return "porous_layers"; }
  bool changes_rows() const override { return true; }  // the resistance depends on the velocity
  void begin(Flow<Dim>& flow) override;
  void arrive(Flow<Dim>& flow) override;
  void begin_projection(Flow<Dim>& flow, Projection projection, double dt) override;
  void change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> acceleration, double dt,
                         std::span<Vec<Dim>> predicted) override;
  void change_target(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient, double dt,
                     std::span<double> target) const override;
  void write_rows(Flow<Dim>& flow) override;
  int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) override;
  void correct(Flow<Dim>& flow, double dt) override;
  void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const override;
  void project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt) override;
  void stay(Flow<Dim>& flow) override;

  PoreSpace at(const Vec<Dim>& x) const override;
  double resistance_at(const Vec<Dim>& x, double speed) const override;
  LatticeSums lattice_of(double volume) const override;
  void warn(const Flow<Dim>& flow) override;

 private:
  /// Data of an owned particle at its arrival.
  struct Arrival {
    std::int64_t id = -1;
    double porosity = 1.0;
  };

  double mean_conductance(const Flow<Dim>& flow, std::size_t i, std::size_t j) const;
  void finish_projection(Flow<Dim>& flow);

  /// The surfaces of a body, through which a layer has no effect.
  struct BodyWalls {
    std::string name;
    std::vector<int> walls;  ///< indices into Boundary::walls
    bool is_told = false;    ///< whether the run has reported that it is in a layer
  };

  PorousField<Dim> field_;
  std::vector<PorousRegion<Dim>> regions_;  ///< of the layers
  std::vector<std::string> region_names_;
  std::vector<BodyWalls> bodies_;
  double min_spacing_ = 0.0;   ///< m; of the first of `lattices_`
  double spacing_step_ = 1.0;  ///< m; between consecutive `lattices_`
  std::vector<LatticeSums> lattices_;
  std::vector<Arrival> arrivals_;

  // Data of the present projection for owned particles; the conductance for ghosts too.
  std::vector<PorousMedium> media_;
  std::vector<double> conductance_;    ///< k
  double work_of_solid_ = 0.0;         ///< J; of viscous forces in the volume of the grains
  std::vector<Vec<Dim>> unprojected_;  ///< m/s; v before pressure and gravity act
};

/// Makes the layers of a case; null if it has none.
template <int Dim>
std::unique_ptr<Part<Dim>> make_porous_layers(const CaseSpec& spec, const Setup<Dim>& setup,
                                              const Boundary<Dim>& boundary);

}  // namespace tailwater
