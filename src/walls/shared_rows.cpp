#include "walls/shared_rows.h"

#include <algorithm>
#include <numeric>

#include "base/for_each.h"
#include "parallel/exchange_plan.h"

namespace tailwater {
namespace {

/// Keeps these entries of a field, in this order.
template <class Value>
void keep_entries(std::span<const std::int32_t> kept, std::vector<Value>& field) {
  std::vector<Value> picked(kept.size());
  for_each(kept.size(), [&](std::size_t k) { picked[k] = field[kept[k]]; });
  field.swap(picked);
}

template <int Dim>
void keep_rows(std::span<const std::int32_t> kept, Walls<Dim>& walls) {
  walls.apply_to_rows([&](auto&... field) { (keep_entries(kept, field), ...); });
}

/// Sends the rows of walls at rest to the ranks that keep them, and stores the received rows.
template <int Dim, class HomeOf>
void take_home(const Communicator& ranks, Walls<Dim>& walls, HomeOf&& home_of) {
  const std::size_t made = walls.particles.size();
  std::vector<std::vector<std::int32_t>> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<std::int32_t> kept;
  for (std::size_t row = 0; row < made; ++row) {  // in order: appends to the list of a rank
    const bool moves = walls.boundary.walls[walls.particles.wall[row]].moves();
    (moves ? kept : sent[home_of(walls.particles.number[row])]).push_back(static_cast<std::int32_t>(row));
  }
  const ExchangePlan plan(ranks, made, sent);
  for (std::size_t k = 0; k < plan.ghosts(); ++k) kept.push_back(static_cast<std::int32_t>(made + k));
  // One field after the other, to limit the peak memory at the start.
  walls.apply_to_rows([&](auto&... field) { ((plan.exchange(field), keep_entries(kept, field)), ...); });
}

}  // namespace

template <int Dim>
SharedRows<Dim>::SharedRows(const Communicator& ranks, Walls<Dim>& walls)
    : ranks_(ranks), numbers_(walls.particles.numbers) {
  if (!ranks.is_alone()) take_home(ranks, walls, [&](std::int64_t number) { return home_of(number); });
  const std::vector<std::int64_t>& number = walls.particles.number;
  const auto moves = [&](std::size_t row) { return walls.boundary.walls[walls.particles.wall[row]].moves(); };
  std::vector<std::int32_t> order(number.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](std::int32_t row) { return std::pair(!moves(static_cast<std::size_t>(row)), number[row]); };
  if (!std::ranges::is_sorted(order, {}, place)) {
    std::ranges::sort(order, {}, place);
    keep_rows(order, walls);
  }
  walls.kept = number.size();
  walls.moving = count_each(walls.kept, moves);
  walls.all = static_cast<std::int64_t>(walls.moving) +
              ranks.sum(static_cast<std::int64_t>(walls.kept) - static_cast<std::int64_t>(walls.moving));
}

template <int Dim>
bool SharedRows<Dim>::find_rows(Walls<Dim>& walls, Particles<Dim>& particles, std::size_t from, std::int64_t first_id) {
  const std::vector<std::int64_t> missing = find_here(walls, particles, from, first_id);
  if (!ranks_.any(!missing.empty())) return true;
  bring(walls, missing);
  return !ranks_.any(!find_here(walls, particles, from, first_id).empty());
}

template <int Dim>
std::size_t SharedRows<Dim>::hand_out(Walls<Dim>& walls, const std::vector<std::vector<std::int32_t>>& sent) {
  const ExchangePlan plan(ranks_, walls.particles.size(), sent);
  walls.apply_to_rows([&](auto&... field) { plan.exchange(field...); });
  list_halo_rows(walls, plan.owned());
  return plan.owned();
}

template <int Dim>
void SharedRows<Dim>::drop_halo_rows(Walls<Dim>& walls, Particles<Dim>& particles) {
  if (halo_rows_.empty()) return;
  std::vector<std::int32_t> row_after(walls.particles.size(), -1);
  for_each(walls.kept, [&](std::size_t row) { row_after[row] = 0; });
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) row_after[particles.wall_row[i]] = 0;
  });
  std::vector<std::int32_t> kept;
  for (std::size_t row = 0; row < row_after.size(); ++row) {  // in order: each row stands after those before it
    if (row_after[row] < 0) continue;
    row_after[row] = static_cast<std::int32_t>(kept.size());
    kept.push_back(static_cast<std::int32_t>(row));
  }
  keep_rows(kept, walls);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) particles.wall_row[i] = row_after[particles.wall_row[i]];
  });
  halo_rows_.clear();
  list_halo_rows(walls, walls.kept);
}

template <int Dim>
int SharedRows<Dim>::home_of(std::int64_t number) const {
  return static_cast<int>(number * ranks_.size() / numbers_);
}

template <int Dim>
std::int32_t SharedRows<Dim>::find(const Walls<Dim>& walls, std::int64_t number) const {
  const std::vector<std::int64_t>& numbers = walls.particles.number;
  const auto look_in = [&](std::size_t begin, std::size_t end) {
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = numbers.begin() + static_cast<std::ptrdiff_t>(end);
    const auto found = std::lower_bound(from, to, number);
    return found != to && *found == number ? static_cast<std::int32_t>(found - numbers.begin()) : -1;
  };
  std::int32_t row = look_in(walls.moving, walls.kept);
  if (row < 0) row = look_in(0, walls.moving);
  if (row >= 0) return row;
  const auto found = std::ranges::lower_bound(halo_rows_, number, {}, &HaloRow::number);
  return found != halo_rows_.end() && found->number == number ? found->row : -1;
}

template <int Dim>
std::vector<std::int64_t> SharedRows<Dim>::find_here(const Walls<Dim>& walls, Particles<Dim>& particles,
                                                     std::size_t from, std::int64_t first_id) const {
  const std::size_t count = particles.size() - from;
  for_each(count, [&](std::size_t n) {
    const std::size_t i = from + n;
    particles.wall_row[i] = particles.is_fluid(i) ? -1 : find(walls, particles.id[i] - first_id);
  });
  std::vector<std::int64_t> missing;
  for (const std::size_t n : indices_where(
           count, [&](std::size_t m) { return !particles.is_fluid(from + m) && particles.wall_row[from + m] < 0; })) {
    missing.push_back(particles.id[from + n] - first_id);
  }
  std::ranges::sort(missing);
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

/// Requests the rows with these numbers from their homes.
template <int Dim>
void SharedRows<Dim>::bring(Walls<Dim>& walls, std::vector<std::int64_t> numbers) {
  const auto size = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<std::int32_t>> asked(size);
  for (std::size_t k = 0; k < numbers.size(); ++k) asked[home_of(numbers[k])].push_back(static_cast<std::int32_t>(k));
  std::vector<int> asker(numbers.size(), ranks_.rank());
  const ExchangePlan question(ranks_, numbers.size(), asked);
  question.exchange(numbers, asker);
  std::vector<std::vector<std::int32_t>> sent(size);
  for (std::size_t k = question.owned(); k < numbers.size(); ++k) {
    const std::int32_t row = find(walls, numbers[k]);
    if (row >= 0) sent[asker[k]].push_back(row);
  }
  hand_out(walls, sent);
}

template <int Dim>
void SharedRows<Dim>::list_halo_rows(const Walls<Dim>& walls, std::size_t from) {
  for (std::size_t row = from; row < walls.particles.size(); ++row) {
    halo_rows_.push_back({walls.particles.number[row], static_cast<std::int32_t>(row)});
  }
  std::ranges::sort(halo_rows_);
}

template class SharedRows<2>;
template class SharedRows<3>;

}  // namespace tailwater
