#include "neighbours/decomposition.h"

#include "base/assert.h"
#include "base/for_each.h"
#include "case/spec.h"
#include "parallel/exchange_plan.h"

namespace tailwater {
namespace {

/// Replaces the owned entries by those received.
template <class Value>
void keep_arrivals(std::size_t owned, std::vector<Value>& field) {
  field.erase(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(owned));
}

template <int Dim>
void move_to_owners(const ExchangePlan& plan, Particles<Dim>& particles) {
  particles.apply_to_fields([&](auto&... field) {
    plan.exchange(field...);
    (keep_arrivals(plan.owned(), field), ...);
  });
  particles.owned = particles.position.size();
}

}  // namespace

template <int Dim>
Decomposition<Dim>::Decomposition(const Communicator& ranks, const ParallelTable& settings)
    : ranks_(ranks), tolerated_imbalance_(settings.imbalance), cuts_(ranks) {}

template <int Dim>
Repartition Decomposition<Dim>::repartition(Particles<Dim>& particles, std::span<const double> work) {
  Repartition repartition;
  if (ranks_.is_alone()) return repartition;
  TAILWATER_ASSERT(work.size() == particles.owned, "one cost per owned particle");
  particles.resize(particles.owned);

  const double own = sum_over(work.size(), 0.0, [&](std::size_t i) { return work[i]; });
  const double all = ranks_.sum(own);
  if (all > 0.0) repartition.imbalance = ranks_.largest(own) * ranks_.size() / all - 1.0;
  if (!cuts_.are_made() || repartition.imbalance > tolerated_imbalance_) {
    cuts_.cut(particles.position, work);
    repartition.is_cut_anew = true;
  }

  std::vector<std::vector<std::int32_t>> sent(static_cast<std::size_t>(ranks_.size()));
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: appends to the list of a rank
    sent[cuts_.part_of(particles.position[i])].push_back(static_cast<std::int32_t>(i));
  }
  repartition.moved = ranks_.sum(static_cast<std::int64_t>(particles.owned - sent[ranks_.rank()].size()));
  if (repartition.moved > 0) move_to_owners(ExchangePlan(ranks_, particles.owned, sent), particles);
  return repartition;
}

template class Decomposition<2>;
template class Decomposition<3>;

}  // namespace tailwater
