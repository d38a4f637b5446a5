// Distribution of the rows of the table of wall particles over the ranks. All ranks have those of walls that move. A
// row of a wall at rest has a home, the rank that always keeps it, whichever part of space that rank holds. Homes have
// equal numbers of rows. Other ranks have it as a halo row while one of their particles needs it.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/communicator.h"
#include "particles/particles.h"
#include "walls/walls.h"

namespace tailwater {

template <int Dim>
class SharedRows {
 public:
  /// Sends the rows that each rank has made to their homes, and sorts the table of this rank. Collective.
  SharedRows(const Communicator& ranks, Walls<Dim>& walls);

  /// Sets the rows of wall particles from index `from` on, whose ids are `first_id` plus their numbers. Fetches missing
  /// rows. Returns whether all were found, on all ranks. Collective.
  bool find_rows(Walls<Dim>& walls, Particles<Dim>& particles, std::size_t from, std::int64_t first_id);

  /// Sends the kept rows sent[q] to rank q. Rows received become halo rows at the end of the table. Returns the index
  /// of the first of them. Collective.
  std::size_t hand_out(Walls<Dim>& walls, const std::vector<std::vector<std::int32_t>>& sent);

  /// Removes the halo rows that no owned particle needs. Row indices change.
  void drop_halo_rows(Walls<Dim>& walls, Particles<Dim>& particles);

 private:
  struct HaloRow {
    std::int64_t number;
    std::int32_t row;

    auto operator<=>(const HaloRow&) const = default;
  };

  int home_of(std::int64_t number) const;
  /// The row with this number on this rank, or -1.
  std::int32_t find(const Walls<Dim>& walls, std::int64_t number) const;
  /// Sets the rows that this rank has, -1 for others. Returns the numbers of the missing ones, each once.
  std::vector<std::int64_t> find_here(const Walls<Dim>& walls, Particles<Dim>& particles, std::size_t from,
                                      std::int64_t first_id) const;
  void bring(Walls<Dim>& walls, std::vector<std::int64_t> numbers);
  void list_halo_rows(const Walls<Dim>& walls, std::size_t from);

  Communicator ranks_;
  std::int64_t numbers_;            ///< upper limit of all numbers, exclusive
  std::vector<HaloRow> halo_rows_;  ///< by number
};

}  // namespace tailwater
