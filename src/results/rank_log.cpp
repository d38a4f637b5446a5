#include "results/rank_log.h"

#include <array>
#include <nlohmann/json.hpp>

#include "neighbours/decomposition.h"
#include "neighbours/neighbourhood.h"
#include "parallel/together.h"

namespace tailwater {

RankLog::RankLog(const Communicator& ranks, const std::filesystem::path& path, std::optional<std::int64_t> kept)
    : ranks_(ranks) {
  if (ranks.is_alone()) return;
  do_on_root(ranks, [&] {
    csv_.emplace(
        path,
        std::vector<std::string>{"time_s", "step", "imbalance", "is_cut_anew", "moved_particles", "particles_least",
                                 "particles_most", "ghosts_mean", "exchange_share", "reduction_share"},
        kept);
  });
}

/// Calls body with each number that grows over the run.
template <class Self, class Body>
void RankLog::for_each_sum(Self& self, Traffic& traffic, Body&& body) {
  body(self.lines_);
  body(self.cuts_);
  body(self.moved_);
  body(self.ghosts_sum_);
  body(self.imbalance_sum_);
  body(self.imbalance_largest_);
  body(traffic.exchange_seconds);
  body(traffic.reduction_seconds);
  body(traffic.exchanges);
  body(traffic.messages);
  body(traffic.bytes);
}

std::vector<double> RankLog::saved() const {
  Traffic traffic = ranks_.is_alone() ? Traffic() : *ranks_.traffic();
  std::vector<double> saved{std::chrono::duration<double>(Clock::now() - start_).count()};
  for_each_sum(*this, traffic, [&](const auto& value) { saved.push_back(static_cast<double>(value)); });
  return saved;
}

void RankLog::restore(std::span<const double> saved) {
  if (ranks_.is_alone()) return;
  last_ = Clock::now();
  start_ = last_ - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(saved[0]));
  std::size_t k = 1;
  for_each_sum(*this, *ranks_.traffic(), [&]<class Value>(Value& value) { value = static_cast<Value>(saved[k++]); });
  at_last_ = *ranks_.traffic();
}

template <int Dim>
void RankLog::write(const Flow<Dim>& flow, const Repartition& repartition) {
  if (ranks_.is_alone()) return;
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - last_).count();
  const Traffic& traffic = *ranks_.traffic();
  double exchange = (traffic.exchange_seconds - at_last_.exchange_seconds) / elapsed / ranks_.size();
  double reduction = (traffic.reduction_seconds - at_last_.reduction_seconds) / elapsed / ranks_.size();
  auto ghosts = static_cast<double>(flow.neighbourhood->halo().plan.ghosts());
  ranks_.sum_each(exchange, reduction, ghosts);
  const auto owned = static_cast<std::int64_t>(flow.state.particles.owned);
  const std::int64_t least = ranks_.least(owned);
  const std::int64_t most = ranks_.largest(owned);
  last_ = now;
  at_last_ = traffic;

  imbalance_sum_ += repartition.imbalance;
  if (lines_ > 0) imbalance_largest_ = std::max(imbalance_largest_, repartition.imbalance);
  ++lines_;
  cuts_ += repartition.is_cut_anew;
  moved_ += repartition.moved;
  ghosts_sum_ += ghosts;
  do_on_root(ranks_, [&] {
    csv_->write(std::array<double, 10>{flow.state.time, static_cast<double>(flow.state.step), repartition.imbalance,
                                       static_cast<double>(repartition.is_cut_anew),
                                       static_cast<double>(repartition.moved), static_cast<double>(least),
                                       static_cast<double>(most), ghosts / ranks_.size(), exchange, reduction});
  });
}

Json RankLog::json() const {
  if (ranks_.is_alone()) return {{"count", 1}};
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count() * ranks_.size();
  const Traffic& traffic = *ranks_.traffic();
  double exchange = traffic.exchange_seconds / elapsed;
  double reduction = traffic.reduction_seconds / elapsed;
  std::int64_t messages = traffic.messages;
  std::int64_t bytes = traffic.bytes;
  ranks_.sum_each(exchange, reduction, messages, bytes);
  return {{"count", ranks_.size()},
          {"imbalance_mean", lines_ > 0 ? imbalance_sum_ / static_cast<double>(lines_) : 0.0},
          {"imbalance_largest", imbalance_largest_},
          {"cuts", cuts_},
          {"moved_particles", moved_},
          {"ghosts", lines_ > 0 ? ghosts_sum_ / static_cast<double>(lines_) : 0.0},
          {"exchange_share", exchange},
          {"reduction_share", reduction},
          {"exchanges", traffic.exchanges},
          {"messages", messages},
          {"bytes", bytes}};
}

template void RankLog::write<2>(const Flow<2>&, const Repartition&);
template void RankLog::write<3>(const Flow<3>&, const Repartition&);

}  // namespace tailwater
