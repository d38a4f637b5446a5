#include "motion/wave_theory.h"

#include <cmath>
#include <numbers>

namespace tailwater {
namespace {

/// Terms of the near field that are kept. They decay as exp(-j pi x/h): half a depth away the sixth is 1e-4 of itself.
constexpr int near_field_terms = 6;

/// Largest height of a periodic wave over its length, and over tanh kh: R. Miche (1944).
constexpr double steepest = 0.142;

/// The root of omega^2 h/g = -y tan y between (j - 1/2) pi and j pi, for j = 1, 2, ...: there y tan y rises from minus
/// infinity to 0.
double near_field_root(double omega2_h_over_g, int j) {
  double low = (j - 0.5) * std::numbers::pi;
  double high = j * std::numbers::pi;
  for (int halving = 0; halving < 60; ++halving) {
    const double y = 0.5 * (low + high);
    (-y * std::tan(y) > omega2_h_over_g ? low : high) = y;
  }
  return 0.5 * (low + high);
}

}  // namespace

double wave_number(double omega, double gravity, double depth) {
  const double target = omega * omega * depth / gravity;  // y tanh y with y = k h
  double y = target / std::sqrt(std::tanh(target));       // C. Eckart (1951): within 5 %
  for (int step = 0; step < 30; ++step) {
    const double tanh_y = std::tanh(y);
    const double change = (target - y * tanh_y) / (tanh_y + y * (1.0 - tanh_y * tanh_y));
    y += change;
    if (std::abs(change) <= 1e-15 * y) break;
  }
  return y / depth;
}

double near_field_wave_number(double omega, double gravity, double depth, int j) {
  return near_field_root(omega * omega * depth / gravity, j) / depth;
}

DepthShape::DepthShape(double a, double z, double h) {
  const double up = std::exp(a * (z - h));
  const double down = std::exp(-a * (z + h));
  const double whole = 1.0 + std::exp(-2.0 * a * h);
  cosh = (up + down) / whole;
  sinh = (up - down) / whole;
}

double MakerTransfer::near_field_at(double distance) const {
  double sum = 0.0;
  for (const NearField& term : near_field) sum += term.share * std::exp(-term.wave_number * distance);
  return sum;
}

MakerTransfer maker_transfer(MakerType type, double omega, double gravity, double depth) {
  // The plate's own shape over the depth, projected on that of each mode: 1 for a piston, 1 + z/h for a flap.
  const bool is_flap = type == MakerType::flap;
  const double y = wave_number(omega, gravity, depth) * depth;
  // Beyond this, sinh overflows; the ratios are those of deep water.
  const double deep = std::min(y, 300.0);
  const double shape = std::sinh(deep) + (is_flap ? (1.0 - std::cosh(deep)) / deep : 0.0);
  MakerTransfer transfer{4.0 * std::sinh(deep) * shape / (std::sinh(2.0 * deep) + 2.0 * deep), {}};
  for (int j = 1; j <= near_field_terms; ++j) {
    const double root = near_field_root(omega * omega * depth / gravity, j);
    const double s = std::sin(root) + (is_flap ? (std::cos(root) - 1.0) / root : 0.0);
    transfer.near_field.push_back({root / depth, 4.0 * std::sin(root) * s / (2.0 * root + std::sin(2.0 * root))});
  }
  return transfer;
}

double plate_reflection(MakerType type, double omega, double gravity, double depth) {
  const MakerTransfer transfer = maker_transfer(type, omega, gravity, depth);
  const double near = transfer.near_field_at(0.0);
  return std::abs(near) / std::hypot(2.0 * transfer.wave, near);
}

double breaking_height(double omega, double gravity, double depth) {
  const double k = wave_number(omega, gravity, depth);
  return steepest * 2.0 * std::numbers::pi / k * std::tanh(k * depth);
}

}  // namespace tailwater
