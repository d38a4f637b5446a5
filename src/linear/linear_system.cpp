#include "linear/linear_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/assert.h"

namespace tailwater {
namespace {

/// Fraction of a constant right-hand side below which its remainder is rounding, which needs no pressure.
constexpr double rounding = 1e-12;

}  // namespace

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns) {
  set_pattern(row_begin, columns, ExchangePlan({}, row_begin.size() - 1, {{}}));
}

void LinearSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                               const ExchangePlan& halo) {
  TAILWATER_ASSERT(columns.size() <= std::numeric_limits<std::uint32_t>::max(), "a rank's entries can be counted");
  weights_ = workspace_.take(columns.size(), columns.size());
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
  sum_.assign(rows, 0.0);
  columns_ = columns;
  row_begin_.assign(row_begin.begin(), row_begin.end());
  bool has_ghosts = false;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::span<const std::int32_t> row = columns.subspan(row_begin[i], row_begin[i + 1] - row_begin[i]);
    TAILWATER_ASSERT(
        std::ranges::is_partitioned(row, [i](std::int32_t j) { return static_cast<std::size_t>(j) < i; }) &&
            std::ranges::is_partitioned(row, [rows](std::int32_t j) { return static_cast<std::size_t>(j) < rows; }),
        "the columns of a row are in order");
    if (!row.empty() && static_cast<std::size_t>(row.back()) >= rows) has_ghosts = true;
  }
  has_ghosts_ = ranks_.any(has_ghosts);
}

void LinearSystem::Row::finish(double diagonal, double rhs) {
  TAILWATER_ASSERT(diagonal != 0.0, "a pressure row has no diagonal");
  const double scale = 1.0 / diagonal;
  system_.rhs_[i_] = scale * rhs;
  system_.scale_[i_] = scale;
}

void LinearSystem::Row::finish_as_zero() {
  set_weights([](std::size_t) { return 0.0F; });
  system_.rhs_[i_] = 0.0;
  system_.scale_[i_] = 0.0;
}

void LinearSystem::divide_diagonal(std::size_t i, double share, double from) {
  rhs_[i] = share * rhs_[i] + (1.0 - share) * from;
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

void LinearSystem::multiply(std::vector<double>& x, std::span<double> y) const {
  if (has_ghosts_) exchange(x);
  const Part whole = this->whole();
  for (std::size_t i = 0; i < size(); ++i) y[i] = x[i] - scale_[i] * whole.sum(i, x.data());
}

}  // namespace tailwater
