// Typed tests over the number of dimensions: TYPED_TEST_SUITE(Name, Dimensions), `TypeParam::value` is Dim.
#pragma once

#include <gtest/gtest.h>

#include <type_traits>

namespace tailwater {

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

}  // namespace tailwater
