// Smoothing kernels W(r) with a support of radius R: W = 0 for r >= R, the integral over space is 1.
#pragma once

#include <variant>

#include "case/choices.h"
#include "kernel/cubic_spline.h"
#include "kernel/farzin.h"
#include "kernel/wendland_c2.h"

namespace tailwater {

/// One of the kernels, chosen by name. Every alternative has `radius` [m], `value(r)` [1/m^Dim], `derivative(r)` =
/// dW/dr [1/m^(Dim+1)] and `steepness(r)`, F = -(dW/dr)/r [1/m^(Dim+2)].
template <int Dim>
using Kernel = std::variant<WendlandC2<Dim>, CubicSpline<Dim>, FarzinKernel<Dim>>;

template <int Dim>
Kernel<Dim> make_kernel(KernelName name, double radius) {
  switch (name) {
    case KernelName::cubic_spline:
      return CubicSpline<Dim>(radius);
    case KernelName::farzin:
      return FarzinKernel<Dim>(radius);
    case KernelName::wendland_c2:
      break;
  }
  return WendlandC2<Dim>(radius);
}

template <int Dim>
double kernel_radius(const Kernel<Dim>& kernel) {
  return std::visit([](const auto& chosen) { return chosen.radius; }, kernel);
}

/// Calls body with the kernel that was chosen. The default one is asked for first, and in the caller's loop.
template <int Dim, class Body>
inline auto with_kernel(const Kernel<Dim>& kernel, Body&& body) {
  if (const auto* wendland = std::get_if<WendlandC2<Dim>>(&kernel)) [[likely]] {
    return body(*wendland);
  }
  return std::visit(body, kernel);
}

/// At one distance, or at several in lanes.
template <int Dim, class Number>
inline Number kernel_value(const Kernel<Dim>& kernel, Number r) {
  return with_kernel<Dim>(kernel, [r](const auto& chosen) { return chosen.value(r); });
}

/// -(dW/dr)/r, never negative; r is not 0.
template <int Dim, class Number>
inline Number kernel_steepness(const Kernel<Dim>& kernel, Number r) {
  return with_kernel<Dim>(kernel, [r](const auto& chosen) { return chosen.steepness(r); });
}

template <int Dim>
double kernel_derivative(const Kernel<Dim>& kernel, double r) {
  return std::visit([r](const auto& chosen) { return chosen.derivative(r); }, kernel);
}

}  // namespace tailwater
