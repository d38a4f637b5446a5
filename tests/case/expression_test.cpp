#include "case/expression.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <numbers>

namespace tailwater {
namespace {

const NamedNumbers numbers{{"H", 0.5}, {"dx", 0.25}};

TEST(Expression, HasTheValueOfArithmetic) {
  EXPECT_EQ(evaluate("2*H", numbers), 1.0);
  EXPECT_EQ(evaluate(" 1 + 2 * 3 ", numbers), 7.0);
  EXPECT_EQ(evaluate("(1 + 2) * 3", numbers), 9.0);
  EXPECT_EQ(evaluate("8/4/2", numbers), 1.0);
  EXPECT_EQ(evaluate("2^3^2", numbers), 512.0);
  EXPECT_EQ(evaluate("-2^2", numbers), -4.0);
  EXPECT_EQ(evaluate("2^-1", numbers), 0.5);
  EXPECT_EQ(evaluate("-H", numbers), -0.5);
  EXPECT_EQ(evaluate("1e-3", numbers), 1e-3);
  EXPECT_EQ(evaluate("2 - -dx", numbers), 2.25);
  EXPECT_EQ(evaluate("abs(-3) + min(4, 2, 3) + max(1, 5)", numbers), 10.0);
  EXPECT_EQ(evaluate("clamp(-1, 0, 2) + clamp(1, 0, 2) + clamp(5, 0, 2)", numbers), 3.0);
  EXPECT_EQ(evaluate("H < 1 ? 2 : 3", numbers), 2.0);
  EXPECT_DOUBLE_EQ(evaluate("sqrt(2)", numbers), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(evaluate("sin(1) + cos(2) + tan(3)", numbers), std::sin(1.0) + std::cos(2.0) + std::tan(3.0));
  EXPECT_EQ(evaluate("pi", numbers), std::numbers::pi);
}

struct BadExpression {
  std::string text;
  std::vector<std::string> message;
};

TEST(Expression, WithoutAValueSaysWhyAndWhere) {
  const std::vector<BadExpression> table{
      {"2*Hh", {"unknown name \"Hh\" at position 3", "did you mean \"H\"?", "\"dx\"", "\"pi\""}},
      {"2 * sqr(4)", {"unknown function \"sqr\" at position 5", "did you mean \"sqrt\"?"}},
      {"0.6 m", {"\"m\" at position 5 follows a number", "SI without a unit"}},
      {"60cm", {"\"cm\" at position 3 follows a number", "SI without a unit"}},
      {"2H", {"\"H\" at position 2 follows a number", "*"}},
      {"0,6", {"2 numbers", "write decimals with a point"}},
      {"(1 + 2", {"parenthesis is not closed"}},
      {"1 +", {"ends too early"}},
      {"2*if(1 < 2, 3, 4)", {"unknown function \"if\" at position 3", "\"a < b ? c : d\""}},
      {"", {"empty"}},
      {"2**3", {"\"**\" at position 2", "\"a^b\""}},
      {"2*/3", {"cannot read \"/\" at position 3"}},
      {"H = 3", {"cannot read \"=\" at position 3"}},
      {"1/0", {"its value is inf", "divisions by zero"}},
      {"sqrt(-1)", {"nan", "roots of negative numbers"}},
      {"10^400", {"inf"}},
  };
  for (const auto& [text, parts] : table) {
    try {
      const double value = evaluate(text, numbers);
      ADD_FAILURE() << '"' << text << "\" has the value " << value;
    } catch (const ExpressionError& error) {
      for (const std::string& part : parts) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << '"' << text << "\": " << error.what() << "\nmisses: " << part;
      }
    }
  }
}

TEST(Formula, TakesItsVariablesAtEachEvaluation) {
  constexpr std::array<std::string_view, 2> variables{"x", "y"};
  Formula formula("H*x - y^2", numbers, variables);
  EXPECT_TRUE(formula.uses_variables());
  EXPECT_EQ(formula.at(std::array{4.0, 1.0}), 1.0);
  EXPECT_EQ(formula.at(std::array{0.0, 3.0}), -9.0);
  EXPECT_TRUE(std::isinf(Formula("1/x", numbers, variables).at(std::array{0.0, 0.0})));
  Formula constant("2*H", numbers, variables);
  EXPECT_FALSE(constant.uses_variables());
  EXPECT_EQ(constant.at(std::array{4.0, 1.0}), 1.0);
}

TEST(Formula, NamesItsVariablesWhenANameIsUnknown) {
  constexpr std::array<std::string_view, 2> variables{"x", "y"};
  try {
    const Formula formula("2*w", numbers, variables);
    FAIL();
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.unknown_name(), "w");
    EXPECT_NE(std::string(error.what()).find("\"y\""), std::string::npos) << error.what();
  }
}

TEST(Expression, NamesTheUnknownName) {
  try {
    evaluate("2*L", numbers);
    FAIL();
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.unknown_name(), "L");
  }
}

TEST(Expression, OfANumberWithoutValueHasNone) {
  const NamedNumbers unknown{{"H", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_TRUE(std::isnan(evaluate("2*H + 1", unknown)));
}

class CommaIsDecimal : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Expression, DoesNotDependOnTheLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaIsDecimal));
  const double value = evaluate("1234.5 * 2", numbers);
  std::locale::global(before);
  EXPECT_EQ(value, 2469.0);
}

TEST(FreeName, IsAnIdentifierThatNobodyTook) {
  for (const char* name : {"H", "_a1", "length_2"}) {
    EXPECT_TRUE(is_free_name(name)) << name;
  }
  for (const char* name : {"", "2H", "a-b", "a b", "pi", "sqrt", "min"}) {
    EXPECT_FALSE(is_free_name(name)) << name;
  }
}

}  // namespace
}  // namespace tailwater
