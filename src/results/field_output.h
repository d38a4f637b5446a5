// The fluid's fields at one instant, as the case selects them, in the order of the particles' ids; and the walls.
#pragma once

#include <string>
#include <vector>

#include "flow/flow.h"
#include "io/vtp_writer.h"

namespace tailwater {

/// Owns the gathered arrays that `view` borrows.
template <int Dim>
class FluidFields {
 public:
  /// Gathers the named fields (see OutputTable::fields) of `particles`, with zones of refinement also their volume and
  /// with several liquids also their liquid; the work fields come from `flow`.
  FluidFields(const Flow<Dim>& flow, const Particles<Dim>& particles, const std::vector<std::string>& names);

  ParticleFields<Dim> view() const;

 private:
  std::vector<std::string> names_;
  std::vector<Vec<Dim>> position_;
  std::vector<Vec<Dim>> velocity_;
  std::vector<double> pressure_;
  std::vector<double> density_error_;
  std::vector<std::int64_t> is_surface_;
  std::vector<double> eddy_viscosity_;
  std::vector<double> shear_rate_;    ///< 1/s; of the last step; 0 of water
  std::vector<double> viscosity_;     ///< Pa s; likewise
  std::vector<std::int64_t> liquid_;  ///< index of its [[liquid]], counted as in the case file
  std::vector<double> density_;       ///< kg/m^3
  std::vector<double> volume_;        ///< m^3; in 2D m^2
  std::vector<std::int64_t> id_;
};

/// The faces of all walls, corner by corner. Owns the data that `view` borrows.
template <int Dim>
class WallFields {
 public:
  explicit WallFields(const Boundary<Dim>& boundary);

  ParticleFields<Dim> view() const;

 private:
  std::vector<Vec<Dim>> corner_;
  std::vector<std::int64_t> wall_;  ///< index of the wall, counted as in the case file
};

}  // namespace tailwater
