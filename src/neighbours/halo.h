// Which owned particle each ghost copies, and how ghosts get their field values. Ghosts are particles of other ranks
// and periodic images.
#pragma once

#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "parallel/exchange_plan.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
struct Halo {
  ExchangePlan plan;
  std::vector<Vec<Dim>> shift;  ///< m; added to the position of each particle sent; empty without a periodic direction

  /// Brings the ghosts' entries of fields up to date, in one message per rank. Each field gets owned + ghosts entries.
  template <class... Value>
  void exchange(std::vector<Value>&... fields) const {
    plan.exchange(fields...);
  }

  void exchange_positions(std::vector<Vec<Dim>>& position) const;
};

/// The zero shift, and every shift [m] by one period in one or more directions.
template <int Dim>
std::vector<Vec<Dim>> image_shifts(const PeriodicDomain<Dim>& domain);

/// Moves owned particles that left a periodic domain in again at its other end.
template <int Dim>
void wrap_positions(const PeriodicDomain<Dim>& domain, Particles<Dim>& particles);

/// Gives `particles` the ghosts within `margin` [m] of the box around the owned ones and copies every field to them.
/// Collective.
template <int Dim>
Halo<Dim> make_halo(const Communicator& ranks, const PeriodicDomain<Dim>& domain, double margin,
                    Particles<Dim>& particles);

}  // namespace tailwater
