#include "linear/multigrid_level.h"

namespace tailwater::multigrid {

void Matrix::reserve(std::size_t rows, std::size_t entries_of_all) {
  begin.reserve(rows + 1);
  middle.reserve(rows);
  diagonal.reserve(rows);
  inverse.reserve(rows);
  entries.reserve(entries_of_all + 1);  // adding a row writes to one entry more
}

void Matrix::add_row(std::span<const Entry> row, double diagonal_of_row) {
  const auto i = static_cast<int>(size());
  const std::size_t first = entries.size();
  entries.resize(first + row.size() + 1);
  Entry* next = entries.data() + first;
  // Each entry is written to the next place of its side, and stays there if it belongs to that side. This avoids a
  // branch that the processor cannot predict.
  for (const Entry& entry : row) {
    *next = entry;
    next += entry.column < i ? 1 : 0;
  }
  middle.push_back(static_cast<int>(next - entries.data()));
  for (const Entry& entry : row) {
    *next = entry;
    next += entry.column > i ? 1 : 0;
  }
  entries.resize(next - entries.data());
  begin.push_back(static_cast<int>(entries.size()));
  diagonal.push_back(static_cast<float>(diagonal_of_row));
  inverse.push_back(diagonal_of_row > 0.0 ? static_cast<float>(1.0 / diagonal_of_row) : 0.0F);
}

}  // namespace tailwater::multigrid
