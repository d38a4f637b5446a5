// Stress of a wall on water that slips along it, for smooth and rough walls:
//
//   u(y) = u_tau/kappa ln(1 + y/y_0),    y_0 = 0.11 nu/u_tau + k_s/30    (turbulent; Nikuradse 1933)
//   u(y) = u_tau^2 y/nu                                                  (laminar)
//
// with the friction velocity u_tau, whose square is the stress over the density, and the equivalent sand roughness k_s.
// The law with the larger stress applies; the two laws meet at y u_tau/nu = 11.33 on a smooth wall.
#pragma once

#include <algorithm>
#include <cmath>

namespace tailwater {

inline constexpr double von_karman = 0.41;

/// Molecular viscosity of the water at a wall, and the wall's roughness.
struct WallLaw {
  double viscosity = 0.0;  ///< m^2/s; nu, molecular
  double roughness = 0.0;  ///< m; k_s

  /// y_0 [m] at this friction velocity [m/s], which is not 0.
  double zero_height(double friction_velocity) const { return 0.11 * viscosity / friction_velocity + roughness / 30.0; }

  /// u_tau [m/s] of the turbulent law if the water moves at `speed` [m/s] at the distance height(u_tau) [m].
  template <class Height>
  double turbulent_friction_velocity(double speed, Height&& height) const {
    return solve(speed, [&](double u_tau) { return std::log1p(height(u_tau) / zero_height(u_tau)); });
  }

  /// u_tau [m/s] of the turbulent law if its mean over the distances 0 .. `depth` [m] is `mean` [m/s].
  double turbulent_friction_velocity_of_mean(double mean, double depth) const {
    return solve(mean, [&](double u_tau) {
      const double y_0 = zero_height(u_tau);
      return (1.0 + y_0 / depth) * std::log1p(depth / y_0) - 1.0;
    });
  }

 private:
  /// Solves u_tau = kappa speed/profile(u_tau). The profile grows at most with the logarithm of u_tau, so fixed-point
  /// passes converge: where the flow is turbulent, each removes nine tenths of the error. A secant through two passes
  /// removes nearly all of it.
  template <class Profile>
  double solve(double speed, Profile&& profile) const {
    if (speed == 0.0 || (viscosity == 0.0 && roughness == 0.0)) return 0.0;
    constexpr int max_passes = 30;
    double u_tau = 0.05 * speed;
    double before = 0.0;
    double change_before = 0.0;
    for (int pass = 0; pass < max_passes; ++pass) {
      const double change = von_karman * speed / profile(u_tau) - u_tau;
      const double slope = pass > 0 ? (change - change_before) / (u_tau - before) : -1.0;
      before = u_tau;
      change_before = change;
      u_tau -= change / std::min(slope, -0.5);
      if (std::abs(u_tau - before) <= 1e-9 * u_tau) break;
    }
    return u_tau;
  }
};

}  // namespace tailwater
