#include "case/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/fp_traps.h"
#include "case/nearest_name.h"

namespace tailwater {

namespace {

constexpr std::size_t longest_text = 5000;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

/// Whether the last letter before `position`, spaces ignored, is a digit or a point.
bool follows_number(std::string_view text, std::size_t position) {
  const std::size_t last = text.substr(0, position).find_last_not_of(' ');
  return last != std::string_view::npos && (is_digit(text[last]) || text[last] == '.');
}

/// The numbers whose names occur in the text. A case may have thousands of parameters, but an expression uses a few.
NamedNumbers used_numbers(std::string_view text, const NamedNumbers& numbers) {
  NamedNumbers used;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
    // A number may end in the letters of its exponent, as in 2e3; muParser reads names that follow one.
    while (begin < end && is_digit(text[begin])) ++begin;
    const auto found = numbers.find(text.substr(begin, end - begin));
    if (found != numbers.end()) used.insert(*found);
    begin = std::max(end, begin) + 1;
  }
  return used;
}

ExpressionError unknown_name_error(const std::string& name, std::size_t position, std::string_view text,
                                   const NamedNumbers& numbers) {
  const std::size_t next = text.find_first_not_of(' ', position + name.size());
  const bool is_call = next != std::string_view::npos && text[next] == '(';
  const std::vector<std::string> functions = function_names();
  std::vector<std::string_view> known;
  if (is_call) {
    known.assign(functions.begin(), functions.end());
  } else {
    known.push_back("pi");
    for (const auto& [number, value] : numbers) known.push_back(number);
  }
  const std::string hint = is_call && name == "if"     ? "write a choice as \"a < b ? c : d\""
                           : name == time_name.front() ? "this value cannot change with time"
                                                       : unknown_name_hint(name, known);
  return ExpressionError(
      fmt::format("unknown {} \"{}\" at position {}; {}", is_call ? "function" : "name", name, position + 1, hint),
      is_call ? std::nullopt : std::optional(name));
}

ExpressionError as_expression_error(const mu::Parser::exception_type& error, const std::string& text,
                                    const NamedNumbers& numbers) {
  // Errors of the text as a whole have no position.
  const auto position = static_cast<std::size_t>(std::max(0, static_cast<int>(error.GetPos())));
  const std::string& token = error.GetToken();
  const bool is_out_of_place = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN || error.GetCode() == mu::ecUNEXPECTED_VAL;
  if (is_out_of_place && is_name(token) && follows_number(text, position)) {
    return ExpressionError(
        fmt::format("\"{}\" at position {} follows a number; write numbers in SI without a unit, and products with *",
                    token, position + 1));
  }
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && is_name(token)) {
    return unknown_name_error(token, position, text, numbers);
  }
  if (error.GetCode() == mu::ecUNEXPECTED_EOF) {
    return ExpressionError("the expression ends too early; write one such as \"2*H\"");
  }
  if (error.GetCode() == mu::ecEMPTY_EXPRESSION) {
    return ExpressionError("the text is empty; write a number or an expression such as \"2*H\"");
  }
  if (position > 0 && position < text.size() && text[position - 1] == '*' && text[position] == '*') {
    return ExpressionError(fmt::format("\"**\" at position {}; write a power as \"a^b\"", position));
  }
  if (error.GetCode() == mu::ecMISSING_PARENS) return ExpressionError("a parenthesis is not closed; add \")\"");
  return ExpressionError(
      fmt::format("cannot read \"{}\" at position {}; write an expression such as \"2*H\"", token, position + 1));
}

double clamp(double x, double low, double high) { return std::min(std::max(x, low), high); }

/// Functions that muParser does not have.
void define_functions(mu::Parser& parser) { parser.DefineFun("clamp", clamp); }

}  // namespace

struct Formula::State {
  mu::Parser parser;
  std::vector<double> variables;  ///< the memory from which the parser reads them
};

Formula::Formula(const std::string& text, const NamedNumbers& numbers, std::span<const std::string_view> variables)
    : state_(std::make_unique<State>()) {
  // The result shows a division by zero.
  const SuspendFpTraps suspended;
  mu::Parser& parser = state_->parser;
  state_->variables.resize(variables.size());
  define_functions(parser);
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  for (const auto& [name, value] : used_numbers(text, numbers)) parser.DefineConst(name, value);
  for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(std::string(variables[i]), &state_->variables[i]);
  if (text.size() > longest_text) {
    throw ExpressionError(
        fmt::format("the expression has {} letters; write one of at most {}, with parameters for its parts",
                    text.size(), longest_text));
  }
  try {
    parser.SetExpr(text);
    int count = 0;
    parser.Eval(count);
    if (count != 1) {
      throw ExpressionError(
          fmt::format("these are {} numbers, separated by commas; write decimals with a point", count));
    }
  } catch (const mu::Parser::exception_type& error) {
    NamedNumbers known = numbers;
    for (const std::string_view name : variables) known.emplace(name, 0.0);
    throw as_expression_error(error, text, known);
  }
}

Formula::Formula(Formula&&) noexcept = default;
Formula::~Formula() = default;

bool Formula::uses_variables() const { return !state_->parser.GetUsedVar().empty(); }

double Formula::at(std::span<const double> values) {
  const SuspendFpTraps suspended;
  std::copy(values.begin(), values.end(), state_->variables.begin());
  return state_->parser.Eval();
}

double evaluate(const std::string& text, const NamedNumbers& numbers) {
  const double value = Formula(text, numbers, {}).at({});
  const NamedNumbers used = used_numbers(text, numbers);
  const bool numbers_are_finite =
      std::all_of(used.begin(), used.end(), [](const auto& number) { return std::isfinite(number.second); });
  if (!std::isfinite(value) && numbers_are_finite) {
    throw ExpressionError(fmt::format("its value is {}; check divisions by zero and roots of negative numbers", value));
  }
  return value;
}

bool is_free_name(std::string_view name) {
  const auto functions = function_names();
  return is_name(name) && name != "pi" && std::find(functions.begin(), functions.end(), name) == functions.end();
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  mu::Parser parser;
  define_functions(parser);
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  return names;
}

}  // namespace tailwater
