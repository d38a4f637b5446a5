// Friction of walls along which a thick liquid slides: that of no slip, at most mu_f times the normal stress that
// presses the liquid on the wall.
//
// Without slip, particle i has the friction w_i mu_i T_i s along its walls, where s = u_i - V and
//
//   T_i = sum_w c_iw (I - n_w n_w^T),      c_iw = 2 (1 + b_iw) w_w F_iw (viscous_operator.h),
//
// the derivative of w_i mu_i q^2/2, q^2 = s . T_i s. Beyond the bound L_i [N] it keeps its direction and has the size
// L_i: the derivative of the convex function L_i q/sqrt(C_i), C_i = sum_w c_iw. The part of the viscous force across
// the wall stays as it is. A pass of the solve takes the tangent at the last velocity s0: the constant friction
// F0 = L_i/(sqrt(C_i) q) T_i s0 acts along s0, and L_i/(sqrt(C_i) q) (T_i - T_i s0 s0^T T_i/q^2) resists across it. A
// particle that a pass turns around sticks in the next pass.
//
// Wall particle w is pressed with N_w: the reaction to the pressure force of its pairs, along its normal, and the
// viscous force across the wall. L_i contains the fraction c_iw d_i/(sum over the fluid) of mu_f max(0, N_w). The
// friction of all particles is thus mu_f times the force that presses on the wall, and a uniform shear begins to slide
// everywhere at once. Derivation: docs/theory/rheology.md.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "flow/flow.h"
#include "rheology/wall_pair.h"

namespace tailwater {

/// Dynamic viscosity [Pa s] of owned fluid particle i at a shear rate [1/s].
using LawOfParticle = std::function<double(std::size_t i, double rate)>;

template <int Dim>
class CoulombFriction {
 public:
  /// Finds what depends on the positions alone.
  void locate(const Flow<Dim>& flow);
  /// Whether the case has such walls; the same on all ranks.
  bool has_walls() const { return has_walls_; }

  /// Forgets which particles slid in the last pass.
  void begin_passes();
  /// Finds the friction at `velocity`, which is up to date on ghosts, as is the `viscosity` [Pa s] of the pass before.
  /// `at_walls` is the velocity of the walls at owned particles, `pressure` [Pa] that which acts. The shear rates [1/s]
  /// of liquid that sticks become those of liquid that slides. Collective.
  void slide(const Flow<Dim>& flow, const WallRates<Dim>& walls, const LawOfParticle& law,
             const std::vector<double>& pressure, std::span<const Vec<Dim>> velocity,
             std::span<const Vec<Dim>> at_walls, std::span<const double> viscosity, std::span<double> rate);
  /// Whether particles have changed between sticking and sliding in the pass that led to `velocity`. Collective.
  bool has_changed(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<const Vec<Dim>> at_walls,
                   std::span<const double> viscosity) const;
  /// Whether a particle slides in this pass. Collective.
  bool slides_anywhere(const Flow<Dim>& flow) const;

  /// The friction [N] of no slip on particle i, less that of the pass, is relief(i) s - offset(i).
  const Mat<Dim>& relief(std::size_t i) const { return relief_[i]; }
  const Vec<Dim>& offset(std::size_t i) const { return offset_[i]; }

  /// The friction over that of no slip, along the walls, of all particles, ghosts too. Collective.
  std::vector<double> fractions(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                std::span<const Vec<Dim>> at_walls, std::span<const double> viscosity) const;

 private:
  struct Contact {
    std::size_t particle;
    Mat<Dim> along = Mat<Dim>::Zero();  ///< 1/m^2; T
    double weight = 0.0;                ///< 1/m^2; C
    double bound = 0.0;                 ///< N; L
    bool slides = false;
    Vec<Dim> direction = Vec<Dim>::Zero();  ///< 1/(m s); T s where it slid
  };
  /// The friction of no slip on a contact over w mu [1/(m s)], and sqrt(s . T s) [1/s].
  struct NoSlip {
    Vec<Dim> along;
    double q;
  };

  bool is_sliding_wall(const Flow<Dim>& flow, std::size_t i) const;
  void find_bounds(const Flow<Dim>& flow, const WallRates<Dim>& walls, const std::vector<double>& pressure,
                   std::span<const Vec<Dim>> velocity, std::span<const double> viscosity);
  NoSlip no_slip(const Contact& contact, const Vec<Dim>& s) const;
  void slide(const Flow<Dim>& flow, const LawOfParticle& law, const Vec<Dim>& s, Contact& contact, double& rate);

  bool has_walls_ = false;
  std::vector<std::size_t> walls_;  ///< owned particles of such walls
  std::vector<Contact> contacts_;   ///< of owned fluid particles
  std::vector<Mat<Dim>> relief_;    ///< N s/m; of owned particles; empty without such walls
  std::vector<Vec<Dim>> offset_;    ///< N
};

}  // namespace tailwater
