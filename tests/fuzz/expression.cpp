// Expressions of named numbers and of variables.
#include <array>
#include <cmath>
#include <string_view>

#include "case/expression.h"
#include "harness.h"

namespace {

using namespace tailwater;

constexpr std::array<std::string_view, 3> variables{"x", "y", "t"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = text_of_input(data, size);
  const NamedNumbers numbers{{"dx", 0.1}, {"g", 9.81}, {"H", 2.0}};
  try {
    if (!std::isfinite(evaluate(text, numbers))) finding("a value that is not finite", text);
  } catch (const ExpressionError&) {
  }
  try {
    Formula formula(text, numbers, variables);
    for (const double value : {0.0, 1.0, -1e15}) formula.at(std::array{value, value, value});
  } catch (const ExpressionError&) {
  }
  is_free_name(text);
  return 0;
}
