// Spare capacity of arrays that are filled again in every step.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace tailwater {

/// Capacity for `count` values: at least a thirty-second more, because the number varies from step to step. There are
/// only eight sizes between a power of two and the next, so that an array can reuse the memory of an earlier array of
/// similar size. Memory that is never written to is free of cost.
constexpr std::size_t with_room(std::size_t count) {
  const std::size_t wanted = count + count / 32;
  const std::size_t step = std::max<std::size_t>(1, std::bit_floor(wanted) / 8);
  return (wanted + step - 1) / step * step;
}

/// For arrays whose values are written before they are read: new values are uninitialised.
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

/// Gives `array` the capacity for `count` values if it is smaller; its old values may be lost. An array that grows
/// while it is written would leave its old memory behind.
template <class Array>
void make_room(Array& array, std::size_t count) {
  if (array.capacity() >= count + count / 32) return;
  Array().swap(array);
  array.reserve(with_room(count));
}

}  // namespace tailwater
