#include "linear/linear_system.h"

#include <algorithm>
#include <numeric>

#include "base/assert.h"

namespace tailwater {

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns) {
  set_pattern(row_begin, columns, ExchangePlan({}, row_begin.size() - 1, {{}}));
}

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                               const ExchangePlan& halo) {
  const std::size_t rows = row_begin.size() - 1;
  const auto count = static_cast<std::int64_t>(rows);
  const std::int64_t first = ranks_.sum_before(count);
  size_of_all_ = ranks_.sum(count);
  std::vector<std::int64_t> number(rows);  // of each unknown, over all ranks
  std::iota(number.begin(), number.end(), first);
  halo.exchange(number);

  ++pattern_number_;
  cells_ = {};
  pattern_begin_.assign(row_begin.begin(), row_begin.end());
  slot_.resize(columns.size());
  diagonal_slot_.resize(rows);
  rhs_.assign(rows, 0.0);
  scale_.assign(rows, 1.0);
  for (Block* block : {&own_, &others_}) {
    block->begin.assign(1, 0);
    block->column.clear();
  }

  /// An entry of a row: the unknown, and the place of its weight; -1 for the diagonal.
  struct Entry {
    std::int64_t number;
    std::ptrdiff_t k;
    bool operator<(const Entry& other) const { return number < other.number; }
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> of_others;  // the entries in others_, whose slots follow those of own_
  own_.column.reserve(columns.size() + rows);
  const auto add_own_row = [&](std::size_t i, std::span<const std::int32_t> row) {  // with ascending columns
    const auto diagonal = static_cast<std::int32_t>(i);
    const auto behind = std::lower_bound(row.begin(), row.end(), diagonal);
    const auto before = static_cast<int>(behind - row.begin());
    const auto begin = static_cast<int>(own_.column.size());
    own_.column.insert(own_.column.end(), row.begin(), behind);
    own_.column.push_back(diagonal);
    own_.column.insert(own_.column.end(), behind, row.end());
    diagonal_slot_[i] = begin + before;
    int* const slot = slot_.data() + row_begin[i];
    for (int k = 0; k < static_cast<int>(row.size()); ++k) slot[k] = begin + k + (k < before ? 0 : 1);
  };
  for (std::size_t i = 0; i < rows; ++i) {
    const std::span<const std::int32_t> row = columns.subspan(row_begin[i], row_begin[i + 1] - row_begin[i]);
    if (row.empty() || (static_cast<std::size_t>(row.back()) < rows && std::is_sorted(row.begin(), row.end()))) {
      add_own_row(i, row);
      for (Block* block : {&own_, &others_}) block->begin.push_back(static_cast<int>(block->column.size()));
      continue;
    }
    const Entry diagonal{first + static_cast<std::int64_t>(i), -1};
    bool has_diagonal = false;
    entries.clear();
    for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) {
      if (!has_diagonal && number[columns[k]] > diagonal.number) {
        entries.push_back(diagonal);
        has_diagonal = true;
      }
      entries.push_back({number[columns[k]], static_cast<std::ptrdiff_t>(k)});
    }
    if (!has_diagonal) entries.push_back(diagonal);
    // Most rows are sorted already, because neighbours are listed by ascending index.
    if (!std::is_sorted(entries.begin(), entries.end())) std::sort(entries.begin(), entries.end());
    for (const Entry& entry : entries) {
      const std::int64_t column = entry.number - first;
      const bool is_own = column >= 0 && column < count;
      Block& block = is_own ? own_ : others_;
      const int slot = static_cast<int>(block.column.size());
      block.column.push_back(static_cast<int>(is_own ? column : entry.number));
      if (entry.k < 0) {
        diagonal_slot_[i] = slot;
      } else {
        slot_[entry.k] = slot;
        if (!is_own) of_others.push_back(static_cast<std::size_t>(entry.k));
      }
    }
    for (Block* block : {&own_, &others_}) block->begin.push_back(static_cast<int>(block->column.size()));
  }
  for (const std::size_t k : of_others) slot_[k] += static_cast<int>(own_.column.size());
  value_.resize(own_.column.size() + others_.column.size());
}

/// Calls body with every slot of row i.
template <class Body>
void LinearSystem::for_each_slot(std::size_t i, Body&& body) const {
  for (int slot = own_.begin[i]; slot < own_.begin[i + 1]; ++slot) body(slot);
  const int first = static_cast<int>(own_.column.size());
  for (int slot = others_.begin[i]; slot < others_.begin[i + 1]; ++slot) body(first + slot);
}

LinearSystem::Row::Row(LinearSystem& system, std::size_t i)
    : system_(system),
      i_(i),
      begin_(system.pattern_begin_[i]),
      end_(system.pattern_begin_[i + 1]),
      slot_(system.slot_.data() + begin_),
      value_(system.value_.data()) {}

void LinearSystem::Row::finish(double diagonal, double rhs) {
  TAILWATER_ASSERT(diagonal != 0.0, "a pressure row has no diagonal");
  const double scale = 1.0 / diagonal;
  system_.for_each_slot(i_, [&](int slot) { value_[slot] *= -scale; });
  value_[system_.diagonal_slot_[i_]] = 1.0;
  system_.rhs_[i_] = scale * rhs;
  system_.scale_[i_] = scale;
}

void LinearSystem::Row::finish_as_zero() {
  system_.for_each_slot(i_, [&](int slot) { value_[slot] = 0.0; });
  finish(1.0, 0.0);
  system_.scale_[i_] = 0.0;
}

void LinearSystem::divide_diagonal(std::size_t i, double share) {
  const int diagonal = diagonal_slot_[i];
  for_each_slot(i, [&](int slot) {
    if (slot != diagonal) value_[slot] *= share;  // the diagonal is scaled to 1
  });
  rhs_[i] *= share;
  scale_[i] *= share;
}

void LinearSystem::make_rhs_consistent() {
  // The unscaled operator is symmetric, so its right-hand side must sum to zero.
  double sum = 0.0;
  for (std::size_t i = 0; i < rhs_.size(); ++i) {
    if (scale_[i] != 0.0) sum += rhs_[i] / scale_[i];
  }
  const double mean = ranks_.sum(sum) / static_cast<double>(size_of_all_);
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] -= mean * scale_[i];
}

void LinearSystem::sweep(std::span<double> solution) const {
  TAILWATER_ASSERT(solution.size() == size(), "the solution must have one entry per row");
  std::fill(solution.begin(), solution.end(), 0.0);
  const auto relax_row = [&](std::size_t i) {
    double sum = rhs_[i] + solution[i];  // the diagonal is 1
    for (int slot = own_.begin[i]; slot < own_.begin[i + 1]; ++slot) {
      sum -= value_[slot] * solution[own_.column[slot]];
    }
    solution[i] = sum;
  };
  for (std::size_t i = 0; i < size(); ++i) relax_row(i);
  for (std::size_t i = size(); i-- > 0;) relax_row(i);
}

}  // namespace tailwater
