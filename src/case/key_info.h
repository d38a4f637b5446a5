// The keys of a table as rows of text. The help, the reference page, the effective case and the messages about missing
// or misspelt keys are made from them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "case/choices.h"
#include "case/spec.h"
#include "case/toml_text.h"

namespace tailwater {

/// One key of a table.
struct KeyInfo {
  std::string_view key;
  std::string type;   ///< "number", "whole number", "text", "choice", "vector", "points", "numbers", "texts"; or the
                      ///< text of the help for a quantity that may vary
  std::string value;  ///< as TOML
  std::string_view unit;  ///< empty: none
  std::string allowed;    ///< the range of a number, the names of a choice; empty: anything of that type
  std::string_view doc;   ///< one line
  Presence presence = Presence::optional;
  Range range = {};                                ///< of a number
  std::span<const std::string_view> choices = {};  ///< of a choice, and of texts that are names from a list
  std::optional<Variables> variables = {};         ///< variables of an expression besides the named numbers
};

/// The variables of an expression, as in the help: "t", "s", or "x, y, z".
std::string_view names_of(Variables variables);

/// The range in words, such as "above 0" or "2 to 5"; empty if all numbers are allowed.
std::string range_text(const Range& range);

/// Visitor for `describe` that makes the rows.
class KeyCollector {
 public:
  void text(std::string_view key, const std::string& value, std::string_view doc,
            Presence presence = Presence::optional);
  void integer(std::string_view key, int value, std::string_view unit, const Range& range, std::string_view doc,
               Presence presence = Presence::optional);
  void number(std::string_view key, double value, std::string_view unit, const Range& range, std::string_view doc,
              Presence presence = Presence::optional);
  void coordinates(std::string_view key, const Coordinates& value, std::string_view unit, std::string_view doc,
                   Presence presence = Presence::optional);
  void varying(std::string_view key, const Varying& value, Variables variables, std::string_view unit,
               std::string_view doc);
  void varying(std::string_view key, const std::optional<Varying>& value, Variables variables, std::string_view unit,
               std::string_view doc);
  void field(std::string_view key, const VectorField& value, Variables variables, std::string_view unit,
             std::string_view doc);
  void points(std::string_view key, const std::vector<Coordinates>& value, std::string_view unit, std::string_view doc);
  void numbers(std::string_view key, const std::vector<double>& value, std::string_view unit, std::string_view doc);
  void texts(std::string_view key, const std::vector<std::string>& value, std::span<const std::string_view> allowed,
             std::string_view doc);

  template <class Enumeration>
  void choice(std::string_view key, Enumeration value, std::string_view doc, Presence presence = Presence::optional) {
    add_choice(key, name_of(value), choices<Enumeration>, doc, presence);
  }

  std::vector<KeyInfo> take() { return std::move(rows_); }

 private:
  void add_choice(std::string_view key, std::string_view value, std::span<const std::string_view> names,
                  std::string_view doc, Presence presence);

  std::vector<KeyInfo> rows_;
};

/// The keys of a table, in the order of their description, with the values they have in `table`.
template <class Table>
std::vector<KeyInfo> keys_of(const Table& table = {}) {
  KeyCollector collector;
  Table::describe(table, collector);
  return collector.take();
}

/// One table of the case file with its keys and their defaults.
struct TableInfo {
  std::string_view name;
  bool is_list = false;  ///< [[name]], any number of times
  std::string_view doc;
  std::vector<KeyInfo> keys;

  /// [name] or [[name]].
  std::string heading() const;
};

/// All tables but [parameters], in the order of their description.
std::vector<TableInfo> case_tables();

}  // namespace tailwater
