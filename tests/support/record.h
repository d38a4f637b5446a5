#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string_view>

namespace tailwater {

/// Leaves an error that a test has measured at a spacing in the test's record, from where `tailwater validate` reads
/// it.
inline void record_error(std::string_view quantity, int dimension, double dx, double error) {
  testing::Test::RecordProperty(fmt::format("{}_{}D_dx{:g}", quantity, dimension, dx), fmt::format("{:.6e}", error));
}

}  // namespace tailwater
