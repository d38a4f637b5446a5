// All loops over particles use these functions. The body is a function of one index that writes only its own row, so
// the function can later pass the range to threads or to a GPU. A body returns its terms of a sum and never adds to a
// variable outside. Loops whose rows depend on each other (lists, sorting, sweeps of a solver) are plain loops. Such a
// loop over owned particles gives the reason on its line, as in `// in order: appends`; the test style.loops requires
// it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tailwater {

template <class Body>
void for_each(std::size_t count, Body&& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

/// Like for_each, for bodies that return a count (a number or a bool); returns the sum.
template <class Body>
std::size_t count_each(std::size_t count, Body&& body) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += body(i);
  return sum;
}

/// `zero` plus the results of the body for each index, added in ascending order.
template <class T, class Body>
T sum_over(std::size_t count, T zero, Body&& body) {
  for (std::size_t i = 0; i < count; ++i) zero += body(i);
  return zero;
}

/// The largest of `least` and the results of the body for each index.
template <class Body>
double largest_over(std::size_t count, double least, Body&& body) {
  for (std::size_t i = 0; i < count; ++i) least = std::max<double>(least, body(i));
  return least;
}

/// The indices for which the condition holds, ascending.
template <class Condition>
std::vector<std::size_t> indices_where(std::size_t count, Condition&& condition) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; ++i) {
    if (condition(i)) indices.push_back(i);
  }
  return indices;
}

}  // namespace tailwater
