// Which ghosts copy which owned particles, and how a field gets to them. Ghosts are periodic images here; with several
// ranks the same plan will also hold particles of other ranks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "particles/particles.h"

namespace tailwater {

/// For each direction the interval that repeats, or none.
template <int Dim>
using PeriodicDomain = std::array<std::optional<std::pair<double, double>>, Dim>;

template <int Dim>
struct Halo {
  std::vector<std::int32_t> source;  ///< ghost k copies the owned particle source[k]
  std::vector<Vec<Dim>> shift;       ///< m; added to its position
  std::size_t owned = 0;

  /// The owned particle that particle `j` is or copies.
  std::int32_t owner(std::int32_t j) const {
    return static_cast<std::size_t>(j) < owned ? j : source[static_cast<std::size_t>(j) - owned];
  }

  /// Brings the ghosts' entries of a field up to date; the field gets owned + ghosts entries.
  template <class Value>
  void exchange(std::vector<Value>& field) const {
    field.resize(owned + source.size());
    for (std::size_t k = 0; k < source.size(); ++k) {
      field[owned + k] = field[source[k]];
    }
  }

  void exchange_positions(std::vector<Vec<Dim>>& position) const;
};

/// The place inside a periodic domain that `position` stands for.
template <int Dim>
Vec<Dim> wrapped(const PeriodicDomain<Dim>& domain, Vec<Dim> position);

/// Moves owned particles that left a periodic domain back in at its other end.
template <int Dim>
void wrap_positions(const PeriodicDomain<Dim>& domain, Particles<Dim>& particles);

/// Gives `particles` the ghosts that lie within `margin` [m] of the domain and copies every field to them.
template <int Dim>
Halo<Dim> make_halo(const PeriodicDomain<Dim>& domain, double margin, Particles<Dim>& particles);

}  // namespace tailwater
