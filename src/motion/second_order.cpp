#include "motion/second_order.h"

#include <cmath>
#include <vector>

#include "motion/wave_theory.h"

namespace tailwater {
namespace {

using Amplitude = std::complex<double>;
constexpr Amplitude imaginary(0.0, 1.0);

/// Modes of each motion that do not travel. The sums converge like the square of their number.
constexpr int evanescent_modes = 60;

/// A mode amplitude cosh k(z + h) exp(-i k x) of the potential, in which k is real or imaginary. Its cosh at the
/// surface is `top`; amplitude times top is finite in deep water, too.
struct Mode {
  Amplitude wave_number;
  Amplitude potential;  ///< m^2/s; at the surface
};

struct FirstOrder {
  double omega;
  Amplitude stroke;
  double surface;  ///< omega^2/g, 1/m: the slope of each mode over its value at the surface
  std::vector<Mode> modes;
};

/// Integrals over the depth of cosh p(z + h)/cosh ph times 1 (piston) or 1 + z/h (flap).
Amplitude shape_integral(MakerType type, Amplitude p, double h) {
  const Amplitude tanh_y = std::tanh(p * h);
  if (type == MakerType::piston) return tanh_y / p;
  return tanh_y / p - (1.0 - 1.0 / std::cosh(p * h)) / (p * p * h);
}

/// The flap's integral of (1 + z/h) cosh p(z + h) cosh q(z + h), or the piston's without the factor, over both values
/// at the surface. By sums and differences of the arguments.
Amplitude product_integral(MakerType type, Amplitude p, Amplitude q, double h) {
  const auto part = [&](Amplitude r) {
    if (std::abs(r * h) < 1e-6) return Amplitude(type == MakerType::piston ? h : 0.5 * h);
    return shape_integral(type, r, h) * std::cosh(r * h);
  };
  return 0.5 * (part(p + q) + part(p - q)) / (std::cosh(p * h) * std::cosh(q * h));
}

/// The integral of sinh p(z + h)/cosh ph cosh q(z + h)/cosh qh.
Amplitude slope_integral(Amplitude p, Amplitude q, double h) {
  const auto part = [&](Amplitude r) { return std::abs(r * h) < 1e-6 ? Amplitude(0.0) : (std::cosh(r * h) - 1.0) / r; };
  return 0.5 * (part(p + q) + part(p - q)) / (std::cosh(p * h) * std::cosh(q * h));
}

FirstOrder first_order(MakerType type, double omega, Amplitude stroke, double gravity, double h) {
  FirstOrder found{omega, stroke, omega * omega / gravity, {}};
  std::vector<Amplitude> numbers{wave_number(omega, gravity, h)};
  for (int j = 1; j <= evanescent_modes; ++j) {
    numbers.push_back(-imaginary * near_field_wave_number(omega, gravity, h, j));
  }
  for (const Amplitude k : numbers) {
    const Amplitude cosh_y = std::cosh(k * h);
    // The integral of cosh^2 over that at the surface.
    const Amplitude norm = 0.5 * (std::tanh(k * h) / k + h / (cosh_y * cosh_y));
    found.modes.push_back({k, -omega * stroke * shape_integral(type, k, h) / (k * norm)});
  }
  return found;
}

/// The horizontal velocity of the bound wave at the plate, projected on the free wave: the pole in the amplitude of
/// each pair of modes cancels.
Amplitude bound_wave(const FirstOrder& flow, Amplitude free, double gravity) {
  const double surface = flow.surface * flow.surface;
  Amplitude sum = 0.0;
  for (const Mode& one : flow.modes) {
    for (const Mode& other : flow.modes) {
      const Amplitude k = one.wave_number;
      const Amplitude l = other.wave_number;
      const Amplitude forcing = imaginary * flow.omega * (k * l + 0.25 * (k * k + l * l) - 1.5 * surface);
      const Amplitude q = k + l;
      sum += one.potential * other.potential * forcing * (-imaginary * q) / (gravity * (q * q - free * free));
    }
  }
  return sum;
}

/// The projection on the free wave of -X phi_xx + (dX/dz) phi_z at the mean place of the plate, which stands for the
/// plate's displacement. The product of two real parts is half of the real part of the product.
Amplitude displaced_plate(MakerType type, const FirstOrder& flow, Amplitude free, double h) {
  Amplitude sum = 0.0;
  for (const Mode& mode : flow.modes) {
    const Amplitude k = mode.wave_number;
    sum += mode.potential * k * k * product_integral(type, k, free, h);
    if (type == MakerType::flap) sum += mode.potential * k / h * slope_integral(k, free, h);
  }
  return 0.5 * flow.stroke * sum;
}

}  // namespace

std::complex<double> second_harmonic_stroke(MakerType type, double omega, std::complex<double> stroke, double gravity,
                                            double depth) {
  const FirstOrder flow = first_order(type, omega, stroke, gravity, depth);
  const Amplitude free = wave_number(2.0 * omega, gravity, depth);
  return (bound_wave(flow, free, gravity) - displaced_plate(type, flow, free, depth)) /
         (2.0 * imaginary * omega * shape_integral(type, free, depth));
}

}  // namespace tailwater
