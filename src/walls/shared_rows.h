// The rows of the table of wall particles, among ranks. All ranks have those of walls that move. A row of a wall at
// rest has a home, the rank that always keeps it, whichever part of space it is in: as many rows on each rank. Other
// ranks have it as a halo row while one of their particles needs it.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/communicator.h"
#include "particles/particles.h"
#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
class SharedRows {
 public:
  /// Takes the rows home that the ranks have made, each its share, and puts the table of this rank in order.
  /// Collective.
  SharedRows(const Communicator& ranks, Walls<Dim>& walls);

  /// Sets the rows of those particles of walls that stand from place `from` on, whose ids are `first_id` and their
  /// numbers. Brings those that are not here. Returns whether all were found, on all ranks. Collective.
  bool find_rows(Walls<Dim>& walls, Particles<Dim>& particles, std::size_t from, std::int64_t first_id);

  /// Sends to rank q the rows sent[q] of those kept here. What others send becomes halo rows, at the end of the table;
  /// returns the first. Collective.
  std::size_t hand_out(Walls<Dim>& walls, const std::vector<std::vector<std::int32_t>>& sent);

  /// Forgets the halo rows that no owned particle needs. Rows change.
  void drop_halo_rows(Walls<Dim>& walls, Particles<Dim>& particles);

 private:
  struct HaloRow {
    std::int64_t number;
    std::int32_t row;

    auto operator<=>(const HaloRow&) const = default;
  };

  int home_of(std::int64_t number) const;
  /// -1: it is not here
  std::int32_t find(const Walls<Dim>& walls, std::int64_t number) const;
  /// Sets the rows that are here, -1 for others. Returns the numbers of those, each once.
  std::vector<std::int64_t> find_here(const Walls<Dim>& walls, Particles<Dim>& particles, std::size_t from,
                                      std::int64_t first_id) const;
  void bring(Walls<Dim>& walls, std::vector<std::int64_t> numbers);
  void list_halo_rows(const Walls<Dim>& walls, std::size_t from);

  Communicator ranks_;
  std::int64_t numbers_;            ///< all are below
  std::vector<HaloRow> halo_rows_;  ///< by number
};

}  // namespace tailwater
