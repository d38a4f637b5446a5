#include "motion/second_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "motion/wave_theory.h"

namespace tailwater {
namespace {

using Amplitude = std::complex<double>;
constexpr Amplitude imaginary(0.0, 1.0);

/// Modes of each motion that do not travel. The sums converge like 1 over their number, so they are extrapolated from
/// those of all and of half of the modes, to 0.3 % up to kh = 2.
constexpr int evanescent_modes = 20;

/// Fraction of the sum of all squared products of two amplitudes that may be left out, with the smallest ones.
constexpr double left_out_pairs = 0.03;

/// A mode amplitude cosh k(z + h) exp(-i k x) of the potential, in which k is real or imaginary. Its cosh at the
/// surface is `top`; amplitude times top is finite in deep water, too.
struct Mode {
  Amplitude wave_number;
  Amplitude potential;  ///< m^2/s; at the surface
};

/// The flow of one motion of the plate, as real part of each mode times exp(i omega t).
struct FirstOrder {
  double omega;
  Amplitude stroke;
  double surface;           ///< omega^2/g, 1/m: the slope of each mode over its value at the surface
  std::vector<Mode> modes;  ///< first the wave that travels
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

FirstOrder first_order(MakerType type, const PlateMotion& motion, double gravity, double h) {
  const double omega = motion.omega;
  FirstOrder found{omega, motion.stroke, omega * omega / gravity, {}};
  std::vector<Amplitude> numbers{wave_number(omega, gravity, h)};
  for (int j = 1; j <= evanescent_modes; ++j) {
    numbers.push_back(-imaginary * near_field_wave_number(omega, gravity, h, j));
  }
  for (const Amplitude k : numbers) {
    const Amplitude cosh_y = std::cosh(k * h);
    // The integral of cosh^2 over that at the surface.
    const Amplitude norm = 0.5 * (std::tanh(k * h) / k + h / (cosh_y * cosh_y));
    found.modes.push_back({k, -omega * motion.stroke * shape_integral(type, k, h) / (k * norm)});
  }
  return found;
}

/// Conjugate numbers of a flow, which is the real part of them times exp(-i omega t): a sum with it has the difference
/// of two frequencies.
FirstOrder conjugate(FirstOrder flow) {
  flow.omega = -flow.omega;
  flow.stroke = std::conj(flow.stroke);
  for (Mode& mode : flow.modes) mode = {-std::conj(mode.wave_number), std::conj(mode.potential)};
  return flow;
}

/// The forcing of the surface, phi_tt + g phi_z, by a mode of either flow, over their potentials.
Amplitude forcing(const FirstOrder& one, const FirstOrder& other, Amplitude k, Amplitude l) {
  const double s = one.surface;
  const double r = other.surface;
  return imaginary * ((one.omega + other.omega) * (k * l - s * r) + 0.5 * one.omega * (l * l - r * r) +
                      0.5 * other.omega * (k * k - s * s));
}

/// The horizontal velocity of the bound waves at the plate, projected on the free wave: the pole in the amplitude of
/// each pair of modes cancels. Only the first `modes` count.
Amplitude bound_waves(const FirstOrder& one, const FirstOrder& other, std::size_t modes, Amplitude free,
                      double gravity) {
  Amplitude sum = 0.0;
  for (const Mode& first : std::span(one.modes).first(modes)) {
    for (const Mode& second : std::span(other.modes).first(modes)) {
      const Amplitude k = first.wave_number;
      const Amplitude l = second.wave_number;
      const Amplitude q = k + l;
      sum += first.potential * second.potential * forcing(one, other, k, l) * (-imaginary * q) /
             (gravity * (q * q - free * free));
    }
  }
  return sum;
}

/// The projection on the free wave of -X phi_xx + (dX/dz) phi_z at the mean place of the plate, for the displacement of
/// one motion in the flow of another.
Amplitude displaced_plate(MakerType type, const FirstOrder& plate, const FirstOrder& flow, std::size_t modes,
                          Amplitude free, double h) {
  Amplitude sum = 0.0;
  for (const Mode& mode : std::span(flow.modes).first(modes)) {
    const Amplitude k = mode.wave_number;
    sum += mode.potential * k * k * product_integral(type, k, free, h);
    if (type == MakerType::flap) sum += mode.potential * k / h * slope_integral(k, free, h);
  }
  return 0.5 * plate.stroke * sum;
}

/// The elevation of the bound wave of the two waves that travel.
Amplitude bound_elevation(const FirstOrder& one, const FirstOrder& other, double gravity, double h) {
  const Mode& first = one.modes.front();
  const Mode& second = other.modes.front();
  const Amplitude k = first.wave_number;
  const Amplitude l = second.wave_number;
  const Amplitude q = k + l;
  const double omega = one.omega + other.omega;
  const Amplitude potential = forcing(one, other, k, l) / (gravity * q * std::tanh(q * h) - omega * omega);
  const Amplitude bernoulli = imaginary * omega * potential + 0.5 * (one.surface * other.surface - k * l) +
                              0.5 * one.omega * other.omega * (one.surface + other.surface) / gravity;
  return -bernoulli / gravity * first.potential * second.potential;
}

/// The waves of a pair of motions. The product of two real parts is half of the real part of the product; both orders
/// of two different motions count.
SecondOrderWave wave_of_pair(MakerType type, const FirstOrder& one, const FirstOrder& other, double gravity, double h) {
  const double omega = one.omega + other.omega;
  const Amplitude free = wave_number(omega, gravity, h);
  const auto flux = [&](std::size_t modes) {
    return bound_waves(one, other, modes, free, gravity) - displaced_plate(type, one, other, modes, free, h) -
           displaced_plate(type, other, one, modes, free, h);
  };
  const Amplitude extrapolated = 2.0 * flux(1 + evanescent_modes) - flux(1 + evanescent_modes / 2);
  const double factor = &one == &other ? 0.5 : 1.0;
  return {omega, (one.modes.front().wave_number + other.modes.front().wave_number).real(),
          factor * extrapolated / (imaginary * omega * shape_integral(type, free, h)),
          factor * bound_elevation(one, other, gravity, h)};
}

/// Square of the product of the amplitudes of both waves that travel.
double size_of_pair(const FirstOrder& one, const FirstOrder& other) {
  return std::norm(one.modes.front().potential * other.modes.front().potential);
}

/// The least size of a pair that counts.
double min_size(const std::vector<FirstOrder>& flows) {
  std::vector<double> sizes;
  for (std::size_t n = 0; n < flows.size(); ++n) {
    for (std::size_t m = 0; m <= n; ++m) sizes.push_back(size_of_pair(flows[n], flows[m]));
  }
  std::ranges::sort(sizes);
  const double all = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  double left_out = 0.0;
  for (const double size : sizes) {
    left_out += size;
    if (left_out > left_out_pairs * all) return size;
  }
  return 0.0;
}

}  // namespace

SecondOrderWave second_harmonic(MakerType type, const PlateMotion& motion, double gravity, double depth) {
  const FirstOrder flow = first_order(type, motion, gravity, depth);
  return wave_of_pair(type, flow, flow, gravity, depth);
}

std::vector<SecondOrderWave> second_order_waves(MakerType type, std::span<const PlateMotion> motions, double slowest,
                                                double gravity, double depth) {
  std::vector<FirstOrder> flows;
  std::vector<FirstOrder> conjugates;
  for (const PlateMotion& motion : motions) {
    flows.push_back(first_order(type, motion, gravity, depth));
    conjugates.push_back(conjugate(flows.back()));
  }
  const double least = min_size(flows);
  std::vector<SecondOrderWave> found;
  for (std::size_t n = 0; n < flows.size(); ++n) {
    for (std::size_t m = 0; m <= n; ++m) {
      if (size_of_pair(flows[n], flows[m]) < least) continue;
      found.push_back(wave_of_pair(type, flows[n], flows[m], gravity, depth));
      if (m == n || flows[n].omega - flows[m].omega < slowest) continue;
      found.push_back(wave_of_pair(type, flows[n], conjugates[m], gravity, depth));
    }
  }
  return found;
}

}  // namespace tailwater
