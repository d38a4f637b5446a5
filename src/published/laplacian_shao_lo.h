// Two-point Laplacian with each particle's own density, Shao & Lo (2003), (B8), in terms of the density ratio
// c = rho/rho_0 and of w = m/rho_0:
//
//   rho_0 div((1/rho) grad p)_i = sum_j c_ij (p_j - p_i),
//   c_ij = 8 w_j/(c_i + c_j)^2 (-dW_ij/dr) r/(r^2 + eta^2),   eta = 0.1 h
//
// The available copy of the paper omits the gradient before W_ij in (B8); r_ij . grad W_ij = r dW/dr, and without it
// the sum does not have the dimensions of a Laplacian. All weights have one sign and pairs of equal mass are symmetric:
// an M-matrix, and the diffused quantity is conserved. With c = 1 and eta = 0 it is the Morris Laplacian, and has its
// exactness: fields linear on a symmetric set; no convergence on a disordered one. The viscous term (B9) with one mu =
// rho_0 nu has the same weights times nu.
#pragma once

namespace tailwater {

/// Coefficient of (v_j - v_i) [1/m^2], never negative.
inline double shao_lo_laplacian_weight(double volume_j, double density_i, double density_j, double r, double dW,
                                       double eta_squared) {
  const double density = density_i + density_j;
  return -8.0 * volume_j * dW * r / (density * density * (r * r + eta_squared));
}

/// eta^2 [m^2] for a kernel of support R = 2h.
inline double shao_lo_eta_squared(double support_radius) {
  const double eta = 0.1 * 0.5 * support_radius;
  return eta * eta;
}

}  // namespace tailwater
