// The porous media of a case as a field of space. The surface of a layer is smoothed with the kernel of the flow over
// the water in front of the walls,
//
//   f(x) = sum_k W(x - x_k) m_k f_k / sum_k W(x - x_k) m_k,
//
// where the nodes x_k of a grid of dx/2 hold the medium f_k as drawn and m_k is the fraction of their cell in front of
// resting walls. A particle that passes a surface then meets a gradual change, and a layer that ends at a wall has no
// surface there. The smoothing keeps the volume of the pores and, for a uniform filter velocity, the resistance across
// a layer, since its kernel is even. Between the nodes the field is linear along each axis.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "kernel/kernel.h"
#include "neighbours/halo.h"
#include "porous/porous_law.h"

namespace tailwater {

template <int Dim>
class PorousField {
 public:
  /// Open water.
  PorousField() = default;
  /// Throws CaseError as PorousRegion does, and for a layer too large for the spacing.
  PorousField(const CaseSpec& spec, const Boundary<Dim>& boundary, const Kernel<Dim>& kernel,
              const PeriodicDomain<Dim>& domain);

  bool is_empty() const { return nodes_.empty(); }
  PorousMedium at(const Vec<Dim>& position) const;
  double porosity_at(const Vec<Dim>& x) const { return at(x).porosity(); }
  /// grad n [1/m]
  Vec<Dim> porosity_gradient_at(const Vec<Dim>& x) const;
  double min_porosity() const { return min_porosity_; }  ///< of all layers; 1 if there is none

 private:
  using Index = std::array<std::int64_t, Dim>;
  using Node = std::array<float, 4>;  ///< the four numbers of a medium

  struct StencilNode {
    Index offset;
    double weight;  ///< 1/m^Dim; of the kernel
  };

  std::vector<StencilNode> find_stencil(const Kernel<Dim>& kernel) const;
  void smooth(const Boundary<Dim>& boundary, const Kernel<Dim>& kernel);
  std::vector<std::size_t> nodes_near_surfaces(int reach) const;
  std::size_t number_of(const Index& index) const;
  Index index_of(std::size_t number) const;
  Vec<Dim> place_of(const Index& index) const;

  PeriodicDomain<Dim> domain_{};
  Vec<Dim> origin_ = Vec<Dim>::Zero();  ///< m; of node 0
  double step_ = 1.0;                   ///< m; between nodes
  Index count_{};
  std::vector<Node> nodes_;
  double min_porosity_ = 1.0;
};

}  // namespace tailwater
