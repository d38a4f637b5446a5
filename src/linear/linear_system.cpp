#include "linear/linear_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/assert.h"
#include "base/room.h"

namespace tailwater {
namespace {

/// Share of a constant right-hand side below which what is left of it is rounding, which no pressure has to answer.
constexpr double rounding = 1e-12;

}  // namespace

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns) {
  set_pattern(row_begin, columns, ExchangePlan({}, row_begin.size() - 1, {{}}));
}

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                               const ExchangePlan& halo) {
  TAILWATER_ASSERT(columns.size() <= std::numeric_limits<std::uint32_t>::max(), "a rank's entries can be counted");
  // At first, and each in one piece of the size of the pairs' slopes, which may have left such a place free
  // (find_pairs.h).
  if (room_ < columns.size()) {
    forget_weights();
    room_ = with_room(columns.size());
    weights_ = std::make_unique_for_overwrite<float[]>(room_);
    columns_ = std::make_unique_for_overwrite<std::int32_t[]>(room_);
  }
  const std::size_t rows = row_begin.size() - 1;
  const auto count = static_cast<std::int64_t>(rows);
  first_number_ = ranks_.sum_before(count);
  size_of_all_ = ranks_.sum(count);
  halo_ = halo;
  std::vector<std::int64_t> number(rows);
  std::iota(number.begin(), number.end(), first_number_);
  halo.exchange(number);
  ghost_number_.assign(number.begin() + static_cast<std::ptrdiff_t>(rows), number.end());

  ++pattern_number_;
  cells_ = {};
  rhs_.assign(rows, 0.0);
  scale_.assign(rows, 1.0);
  const auto row_of = [&](std::size_t i) { return columns.subspan(row_begin[i], row_begin[i + 1] - row_begin[i]); };
  for (Part& part : parts_) part.begin.assign(rows + 1, 0);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::span<const std::int32_t> row = row_of(i);
    const auto is_before = [i](std::int32_t j) { return static_cast<std::size_t>(j) < i; };
    const auto is_own = [rows](std::int32_t j) { return static_cast<std::size_t>(j) < rows; };
    TAILWATER_ASSERT(std::ranges::is_partitioned(row, is_before) && std::ranges::is_partitioned(row, is_own),
                     "the columns of a row are in order");
    const auto diagonal = std::ranges::partition_point(row, is_before);
    const auto ghost = std::ranges::partition_point(row, is_own);
    const std::array ends{row.begin(), diagonal, ghost, row.end()};
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      std::vector<std::uint32_t>& begin = parts_[n].begin;
      begin[i + 1] = begin[i] + static_cast<std::uint32_t>(ends[n + 1] - ends[n]);
    }
  }
  std::size_t place = 0;
  for (Part& part : parts_) {
    const std::size_t entries_of_part = part.begin.back();
    part.column = {columns_.get() + place, entries_of_part};
    part.weight = {weights_.get() + place, entries_of_part};
    place += entries_of_part;
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const std::int32_t* entry = row_of(i).data();
    for (Part& part : parts_) {
      const std::size_t entries = part.begin[i + 1] - part.begin[i];
      std::copy_n(entry, entries, part.column.data() + part.begin[i]);
      entry += entries;
    }
  }
  has_ghosts_ = ranks_.any(!ghosts().column.empty());
}

std::vector<std::int32_t> LinearSystem::columns() const {
  std::vector<std::int32_t> columns;
  empty_with_room(columns, entries());
  for (std::size_t i = 0; i < size(); ++i) {
    for (const Part& part : parts_) {
      columns.insert(columns.end(), part.column.data() + part.begin[i], part.column.data() + part.begin[i + 1]);
    }
  }
  return columns;
}

void LinearSystem::forget_weights() {
  for (Part& part : parts_) part = {};
  columns_.reset();
  weights_.reset();
  room_ = 0;
}

void LinearSystem::Row::finish(double diagonal, double rhs) {
  TAILWATER_ASSERT(diagonal != 0.0, "a pressure row has no diagonal");
  const double scale = 1.0 / diagonal;
  system_.rhs_[i_] = scale * rhs;
  system_.scale_[i_] = scale;
}

void LinearSystem::Row::finish_as_zero() {
  for (Part& part : system_.parts_) {
    std::fill(part.weight.data() + part.begin[i_], part.weight.data() + part.begin[i_ + 1], 0.0F);
  }
  system_.rhs_[i_] = 0.0;
  system_.scale_[i_] = 0.0;
}

void LinearSystem::divide_diagonal(std::size_t i, double share) {
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
  for (std::size_t i = 0; i < rhs_.size(); ++i) {
    const double constant = mean * scale_[i];
    rhs_[i] -= constant;
    if (std::abs(rhs_[i]) < rounding * std::abs(constant)) rhs_[i] = 0.0;
  }
}

void LinearSystem::multiply(std::span<const double> x, std::span<double> y) const {
  for (std::size_t i = 0; i < size(); ++i) {
    y[i] = x[i] - scale_[i] * (before().sum(i, x.data()) + behind().sum(i, x.data()));
  }
  if (!has_ghosts_) return;
  std::vector<double> with_ghosts(x.begin(), x.end());
  exchange(with_ghosts);
  for (std::size_t i = 0; i < size(); ++i) y[i] -= scale_[i] * ghosts().sum(i, with_ghosts.data());
}

}  // namespace tailwater
