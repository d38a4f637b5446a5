// Room in arrays that are filled anew in every step.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

namespace tailwater {

/// Values to set memory aside for where `count` are wanted: what varies from step to step has room, a thirty-second at
/// least. There are only eight sizes between a power of two and the next, so that an array finds the place that one of
/// as many values has left. What is not written to takes no memory.
constexpr std::size_t with_room(std::size_t count) {
  const std::size_t wanted = count + count / 32;
  const std::size_t step = std::max<std::size_t>(1, std::bit_floor(wanted) / 8);
  return (wanted + step - 1) / step * step;
}

/// Empties `array` and gives it room for `count` values, if it has not. An array that grows as it is written would
/// leave its old ones behind.
template <class Value>
void empty_with_room(std::vector<Value>& array, std::size_t count) {
  if (array.capacity() < count + count / 32) {
    std::vector<Value>().swap(array);
    array.reserve(with_room(count));
  }
  array.clear();
}

}  // namespace tailwater
