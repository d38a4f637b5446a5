// Which patches of walls water reaches, from the places of particles. A film between two walls, and a sharp corner, may
// have no particle. A gap between two walls is such a film if water reaches it: a closed gap is dry.
#pragma once

#include <cstdint>
#include <vector>

#include "flow/flow.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

/// A patch that may be wet.
template <int Dim>
struct PatchInReach {
  int face;                    ///< index into Boundary::faces
  Vec<Dim> centre;             ///< m; of the part that no other wall takes
  bool may_be_hidden = false;  ///< whether it is behind another wall, which hides the water in front of that
  bool is_left_over = false;   ///< whether other walls take more than half of it: it counts as wet
};

template <int Dim>
class WetPatches {
 public:
  /// Collective.
  WetPatches(const Flow<Dim>& flow, std::vector<PatchInReach<Dim>> patches);

  bool is_wet(std::size_t n) const { return is_wet_[n] != 0; }

 private:
  const WallFace<Dim>& face(std::size_t n) const { return flow_.walls.boundary.faces[patches_[n].face]; }
  Vec<Dim> eye(std::size_t n) const;
  bool sees(std::size_t n, const Vec<Dim>& to) const;
  std::vector<double> find_water_in_front() const;
  /// Water and walls near a patch.
  struct Neighbourhood {
    bool has_water = false;
    bool is_film = false;
  };
  Neighbourhood look_around(const std::vector<double>& water_in_front, std::size_t n) const;
  bool is_next_to(std::size_t n, std::size_t m) const;

  const Flow<Dim>& flow_;
  std::vector<PatchInReach<Dim>> patches_;
  std::vector<double> spacing_;  ///< m; of the particles there
  CellGrid<Dim> grid_;           ///< of the centres
  std::vector<std::uint8_t> is_wet_;
};

}  // namespace tailwater
