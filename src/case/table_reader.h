// Reads one table of a case file, key by key, with the keys' own ranges and types.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "case/expression.h"
#include "case/key_info.h"
#include "case/problems.h"

namespace tailwater {

/// " in m", or empty for a number without unit.
std::string in_unit(std::string_view unit);

/// For a key in the wrong place: "it belongs to " the tables that contain it and "; ", or nothing.
std::string home_of(std::string_view key);

/// The number in a node, if it is one. A large whole number is rounded, because toml++ has no double for it.
std::optional<double> number_in(const toml::node& node);

/// State that is common to the tables of one file while they are read.
struct Context {
  Context(const std::string& file, std::filesystem::path home) : problems(file), folder(std::move(home)) {}

  Problems problems;
  std::filesystem::path folder;  ///< base of relative names of files in the case
  NamedNumbers numbers;
  int dimension = 0;                 ///< 0: unknown, because the file gives an invalid one
  std::set<std::string> keys_done;   ///< full keys that were read ahead of their table
  std::set<std::string> keys_wrong;  ///< full keys that have no usable value
};

/// Visitor for `describe` that reads one table of the file. Keys that are absent keep their value.
class TableReader {
 public:
  /// `source` is null if the file does not have the table.
  TableReader(Context& context, const toml::table* source, CaseLabel table)
      : context_(context), source_(source), table_(std::move(table)) {}

  void text(std::string_view key, std::string& value, std::string_view doc, Presence presence = Presence::optional);
  void integer(std::string_view key, int& value, std::string_view unit, const Range& range, std::string_view doc,
               Presence presence = Presence::optional);
  void number(std::string_view key, double& value, std::string_view unit, const Range& range, std::string_view doc,
              Presence presence = Presence::optional);
  void coordinates(std::string_view key, Coordinates& value, std::string_view unit, std::string_view doc,
                   Presence presence = Presence::optional);
  void varying(std::string_view key, Varying& value, Variables variables, std::string_view unit, std::string_view doc);
  /// "" means no value, as in the effective case.
  void varying(std::string_view key, std::optional<Varying>& value, Variables variables, std::string_view unit,
               std::string_view doc);
  void field(std::string_view key, VectorField& value, Variables variables, std::string_view unit,
             std::string_view doc);
  void points(std::string_view key, std::vector<Coordinates>& value, std::string_view unit, std::string_view doc);
  void numbers(std::string_view key, std::vector<double>& value, std::string_view unit, std::string_view doc);
  void texts(std::string_view key, std::vector<std::string>& value, std::span<const std::string_view> allowed,
             std::string_view doc);

  template <class Enumeration>
  void choice(std::string_view key, Enumeration& value, std::string_view doc, Presence presence = Presence::optional) {
    if (const auto index = chosen(key, choices<Enumeration>, doc, presence)) {
      value = static_cast<Enumeration>(*index);
    }
  }

  /// Reads only these keys now, because defaults or meanings of the others depend on them.
  template <class Table>
  void read_ahead(Table& table, std::initializer_list<std::string_view> keys) {
    only_ = keys;
    Table::describe(table, *this);
    only_.clear();
    for (const std::string_view key : keys) context_.keys_done.insert(full(key));
  }

  /// The node of a key in the file; null if there is none.
  const toml::node* given(std::string_view key) const { return source_ == nullptr ? nullptr : source_->get(key); }
  /// Whether a problem with this key has been reported.
  bool is_wrong(std::string_view key) const { return context_.keys_wrong.contains(full(key)); }
  /// 2 or 3; 0 if the file gives an invalid one.
  int dimension() const { return context_.dimension; }

  /// The file that the case names, relative to its own folder. Throws InputError for a name that cannot be written into
  /// the effective case of a run.
  std::filesystem::path linked(const std::string& file) const;

  /// Reports a problem with the value of `key`, or with the part of it at `place`.
  void wrong(MessageId id, std::string_view key, const toml::node& node, const std::string& message,
             std::string_view place = "");
  /// Reports a problem with the node of a key in the file.
  void wrong(MessageId id, std::string_view key, const std::string& message) { wrong(id, key, *given(key), message); }
  template <class First, class... Rest>
  void wrong(MessageId id, std::string_view key, fmt::format_string<First, Rest...> text, First&& first,
             Rest&&... rest) {
    wrong(id, key, fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
  }

  /// Reports a key that is required and absent.
  void missing(MessageId id, std::string_view key, const std::string& message);

  /// Reports keys in the file that the table does not have.
  void report_unknown_keys(std::span<const KeyInfo> keys);

 private:
  std::string full(std::string_view key) const { return table_.with_key(key).text(); }

  /// The value given for a key; null if it was read ahead or is absent. Reports a missing required key.
  const toml::node* find(std::string_view key, std::string_view doc, std::string_view unit, std::string_view allowed,
                         Presence presence);

  /// The index in `names` of the choice given for a key.
  std::optional<std::size_t> chosen(std::string_view key, std::span<const std::string_view> names, std::string_view doc,
                                    Presence presence);

  /// The list given for a key; null if there is none, or if it is no list, which is reported with `wanted` as remedy.
  const toml::array* list_at(std::string_view key, const toml::node* node, const std::string& wanted);

  /// The number that a node of `key` represents, if it does.
  std::optional<double> evaluated(std::string_view key, std::string_view place, const toml::node& node,
                                  std::string_view unit);

  /// The number or the expression that a node of `key` represents, if it does.
  std::optional<Varying> read_varying(std::string_view key, const std::string& place, const toml::node& node,
                                      Variables variables, std::string_view unit);

  /// A node of `key` as a list of `dimension` entries; null if it is something else, which is reported.
  const toml::array* components(std::string_view key, const std::string& place, const toml::node& node,
                                std::string_view unit);

  /// The numbers of a list, if all of them are; `place` is the list's place in the key, such as `points[2]`.
  std::optional<std::vector<double>> elements(std::string_view key, const std::string& place, const toml::array& list,
                                              std::string_view unit);

  /// The numbers of a list of `dimension` numbers.
  std::optional<Coordinates> point(std::string_view key, const std::string& place, const toml::node& node,
                                   std::string_view unit);

  Context& context_;
  const toml::table* source_;
  CaseLabel table_;
  std::vector<std::string_view> only_;
};

}  // namespace tailwater
