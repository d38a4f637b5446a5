// Which wall particles are near the water. Only they become particles of the flow: dry walls take no part in lists,
// pairs and rows, so a tank twice as high costs the same. Space is divided into cells. A cell is near if it or one
// beside it holds water; its edge is as long as the water reaches within a step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "neighbours/halo.h"
#include "walls/walls.h"

namespace tailwater {

/// Whether walls that are no longer near still count as near.
enum class FarWalls { kept, dropped };

template <int Dim>
class NearWalls {
 public:
  /// Starts without walls, except the moving ones, which always have particles. `reach` [m] is the distance within
  /// which water interacts with walls, including its motion. Collective.
  NearWalls(const Communicator& ranks, const Walls<Dim>& walls, const PeriodicDomain<Dim>& domain, double reach);

  /// Finds which walls are near, and returns those of the rows kept here that were not before. Collective.
  std::vector<std::int32_t> update(const Walls<Dim>& walls, const Particles<Dim>& particles, FarWalls far);

  bool is_near(const Walls<Dim>& walls, std::int32_t row) const {
    return static_cast<std::size_t>(row) < walls.moving || is_near_[cell_of(walls.particles.position[row])] != 0;
  }

  /// Whether water of this rank is where walls that it may reach are not near.
  bool misses_some(const Particles<Dim>& particles) const;

  /// Takes the walls that are among the particles of all ranks as those that are near. Collective.
  void restore(const Walls<Dim>& walls, const Particles<Dim>& particles);

 private:
  std::int32_t cell_of(const Vec<Dim>& place) const;
  template <class Visit>
  void for_each_beside(std::int32_t cell, Visit&& visit) const;
  void find_covered();

  Communicator ranks_;
  std::vector<Vec<Dim>> images_;  ///< m; shifts of the water to its periodic images and to itself
  Vec<Dim> origin_ = Vec<Dim>::Zero();
  double edge_;                            ///< m
  std::array<std::int32_t, Dim> count_{};  ///< cells per direction: those that hold rows, and one more on each side
  std::vector<std::uint8_t> has_rows_;     ///< by cell: of walls at rest, on any rank
  std::vector<std::uint8_t> is_near_;      ///< by cell
  std::vector<std::uint8_t> is_covered_;   ///< by cell: whether all rows in it and beside it are near
};

}  // namespace tailwater
