// Divides space into one part per rank with equal sums of the weights of points: Zoltan's recursive coordinate
// bisection (Devine et al. 2002).
#pragma once

#include <memory>
#include <span>
#include <string>

#include "base/vec.h"
#include "parallel/communicator.h"

namespace tailwater {

template <int Dim>
class SpaceCuts {
 public:
  /// Throws SolverError when Zoltan does not start.
  explicit SpaceCuts(const Communicator& ranks);
  ~SpaceCuts();
  SpaceCuts(SpaceCuts&&) noexcept;
  SpaceCuts& operator=(SpaceCuts&&) noexcept;

  /// Makes new parts from the points [m] of all ranks and their weights. Collective; throws SolverError.
  void cut(std::span<const Vec<Dim>> points, std::span<const double> weights);

  bool are_made() const;

  /// The cuts as bytes of this rank, from which `restore` makes them again, also as the starting point of the next
  /// `cut`. Empty if there are none.
  std::string bytes() const;
  /// Takes the bytes from the same rank of a run with as many ranks. Collective; throws SolverError.
  void restore(std::string bytes);

  /// The rank in whose part `place` lies. Works for any place, with or without points.
  int part_of(const Vec<Dim>& place) const;

 private:
  struct Zoltan;
  Communicator ranks_;
  std::unique_ptr<Zoltan> zoltan_;
};

}  // namespace tailwater
