// Numbers written as expressions of named numbers, such as "2*H" or "sqrt(g*H)".
//
// The arithmetic is muParser's: + - * / ^ (right-associative, binds tighter than the sign: -2^2 = -4), parentheses and
// its functions (sqrt, sin, cos, tan, abs, min, max, exp, ...), the choice a < b ? c : d, and clamp(x, low, high). The
// decimal sign is the point in every locale.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// The named numbers an expression may use, besides pi.
using NamedNumbers = std::map<std::string, double, std::less<>>;

/// An expression without a value; what() has the reason, the position in the text (the first letter is 1) and the
/// remedy.
class ExpressionError : public std::runtime_error {
 public:
  explicit ExpressionError(const std::string& message, std::optional<std::string> unknown_name = {})
      : std::runtime_error(message), unknown_name_(std::move(unknown_name)) {}
  /// The undefined name that the expression uses, if that is the reason.
  const std::optional<std::string>& unknown_name() const { return unknown_name_; }

 private:
  std::optional<std::string> unknown_name_;
};

/// The value of `text`. It is finite unless one of its numbers is not. Throws ExpressionError.
double evaluate(const std::string& text, const NamedNumbers& numbers);

/// An expression of `numbers` and of `variables`, which take their values at each evaluation; read once.
class Formula {
 public:
  /// No variable may have the name of a number. Throws ExpressionError.
  Formula(const std::string& text, const NamedNumbers& numbers, std::span<const std::string_view> variables);
  Formula(Formula&&) noexcept;
  ~Formula();

  /// Whether the value varies: the text uses one of the variables.
  bool uses_variables() const;

  /// The value with the variables at `values`, in their order; it may be infinite or not a number.
  double at(std::span<const double> values);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether `name` can be the name of a number: letters, digits and _, no digit first, not pi nor a function.
bool is_free_name(std::string_view name);

/// The functions an expression may call, in alphabetical order.
std::vector<std::string> function_names();

}  // namespace tailwater
