// Smoothing kernels W(r) with a support of radius R: W = 0 for r >= R, the integral over space is 1.
#pragma once

#include <variant>

#include "case/choices.h"
#include "kernel/cubic_spline.h"
#include "kernel/farzin.h"
#include "kernel/wendland_c2.h"

namespace tailwater {

/// One of the kernels, chosen by name. Visit it once per loop: `std::visit([&](const auto& kernel) {...}, chosen)`;
/// every alternative has `radius` [m], `value(r)` [1/m^Dim] and `derivative(r)` = dW/dr [1/m^(Dim+1)].
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

template <int Dim>
double kernel_value(const Kernel<Dim>& kernel, double r) {
  return std::visit([r](const auto& chosen) { return chosen.value(r); }, kernel);
}

template <int Dim>
double kernel_derivative(const Kernel<Dim>& kernel, double r) {
  return std::visit([r](const auto& chosen) { return chosen.derivative(r); }, kernel);
}

}  // namespace tailwater
