// Room in arrays that are filled anew in every step.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
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

/// For arrays whose values are written before they are read: new values are what was in memory.
template <class Value>
struct UnwrittenAllocator : std::allocator<Value> {
  static void construct(Value* place) { ::new (static_cast<void*>(place)) Value; }
  template <class... Arguments>
  static void construct(Value* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) Value(std::forward<Arguments>(arguments)...);
  }
};
template <class Value>
using UnwrittenArray = std::vector<Value, UnwrittenAllocator<Value>>;

/// Gives `array` room for `count` values, if it has not, which may take those that it holds. An array that grows as it
/// is written would leave its old ones behind.
template <class Array>
void make_room(Array& array, std::size_t count) {
  if (array.capacity() >= count + count / 32) return;
  Array().swap(array);
  array.reserve(with_room(count));
}

}  // namespace tailwater
