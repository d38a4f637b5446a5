#include "case/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "base/error.h"
#include "case/expression.h"
#include "case/formulation.h"
#include "case/key_info.h"
#include "case/key_use.h"
#include "case/nearest_name.h"
#include "case/overrides.h"
#include "case/toml_text.h"

namespace tailwater {

namespace {

// --- Values as messages show them -------------------------------------------------------------------------------

std::string full_value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return toml_string(text->get());
  }
  if (const auto* number = node.as_integer()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* flag = node.as_boolean()) {
    return flag->get() ? "true" : "false";
  }
  if (const auto* array = node.as_array()) {
    std::vector<std::string> elements;
    for (const toml::node& element : *array) {
      elements.push_back(full_value_text(element));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  return node.is_table() ? "{...}" : "a date or time";
}

std::string value_text(const toml::node& node) {
  constexpr std::size_t longest = 60;
  const std::string text = full_value_text(node);
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

/// For a key in the wrong table: the tables that have it.
std::string home_of(std::string_view key) {
  std::vector<std::string> homes;
  for (const TableInfo& table : case_tables()) {
    for (const KeyInfo& info : table.keys) {
      if (info.key == key) {
        homes.push_back(table.heading());
      }
    }
  }
  return homes.empty() ? "" : fmt::format("it belongs to {}; ", fmt::join(homes, " or "));
}

std::string in_unit(std::string_view unit) { return unit.empty() ? "" : fmt::format(" in {}", unit); }

// --- Problems and what all tables share -------------------------------------------------------------------------

/// Everything wrong with the case, reported at once.
class Problems {
 public:
  /// `source` is where the thing is in a file or an override; none: the file as a whole.
  void add(const std::string& file, const toml::source_region* source, const std::string& message) {
    if (source == nullptr || !source->begin) {
      lines_.push_back({std::numeric_limits<unsigned>::max(), fmt::format("{}: {}", file, message)});
    } else if (source->path && source->path->starts_with(override_prefix)) {
      lines_.push_back({0, fmt::format("{}: {}", *source->path, message)});
    } else {
      lines_.push_back(
          {source->begin.line, fmt::format("{}:{}:{}: {}", file, source->begin.line, source->begin.column, message)});
    }
  }

  void add_override(const std::string& message) { lines_.push_back({0, message}); }

  bool none() const { return lines_.empty(); }

  /// One line per problem: overrides, then the file from top to bottom, then what is missing.
  std::string text() {
    std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
    std::vector<std::string_view> texts;
    for (const Line& line : lines_) {
      texts.push_back(line.text);
    }
    return fmt::format("{}", fmt::join(texts, "\n"));
  }

 private:
  struct Line {
    unsigned number;  ///< in the file
    std::string text;
  };
  std::vector<Line> lines_;
};

struct Context {
  std::string file;
  Problems problems;
  NamedNumbers numbers;
  int dimension = 0;                 ///< 0: not known, because the file gives a wrong one
  std::set<std::string> keys_done;   ///< full keys that were read ahead of their table
  std::set<std::string> keys_wrong;  ///< full keys that have no usable value
};

// --- One table --------------------------------------------------------------------------------------------------

/// Visitor for `describe` that reads one table of the file. Keys that are absent keep their value.
class TableReader {
 public:
  /// `source` is null if the file does not have the table; `name` is its name in messages and overrides, `fluid[0]`.
  TableReader(Context& context, const toml::table* source, std::string name)
      : context_(context), source_(source), name_(std::move(name)) {}

  void text(std::string_view key, std::string& value, std::string_view doc, Presence presence = Presence::optional) {
    if (const toml::node* node = find(key, doc, "", "", presence)) {
      if (const auto* given = node->as_string()) {
        value = given->get();
      } else {
        wrong(key, *node, "give a text in quotes");
      }
    }
  }

  void integer(std::string_view key, int& value, std::string_view unit, const Range& range, std::string_view doc,
               Presence presence = Presence::optional) {
    const toml::node* node = find(key, doc, unit, range_text(range), presence);
    const auto given = node == nullptr ? std::nullopt : evaluated(key, key, *node, unit);
    if (!given) {
      return;
    }
    const bool is_int = std::trunc(*given) == *given && std::abs(*given) <= std::numeric_limits<int>::max();
    if (is_int && range.contains(*given)) {
      value = static_cast<int>(*given);
    } else {
      wrong(key, *node, fmt::format("give a whole number, {}{}", range_text(range), in_unit(unit)));
    }
  }

  void number(std::string_view key, double& value, std::string_view unit, const Range& range, std::string_view doc,
              Presence presence = Presence::optional) {
    const toml::node* node = find(key, doc, unit, range_text(range), presence);
    const auto given = node == nullptr ? std::nullopt : evaluated(key, key, *node, unit);
    if (!given) {
      return;
    }
    if (range.contains(*given)) {
      value = *given;
    } else {
      const std::string result = node->is_string() ? fmt::format("its value {} is ", *given) : "";
      wrong(key, *node, fmt::format("{}out of range; give a number {}{}", result, range_text(range), in_unit(unit)));
    }
  }

  void coordinates(std::string_view key, Coordinates& value, std::string_view unit, std::string_view doc) {
    if (const toml::node* node = find(key, doc, unit, "", Presence::optional)) {
      if (auto given = point(key, std::string(key), *node, unit)) {
        value = std::move(*given);
      }
    }
  }

  void points(std::string_view key, std::vector<Coordinates>& value, std::string_view unit, std::string_view doc) {
    const toml::node* node = find(key, doc, unit, "", Presence::optional);
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      wrong(key, *node, fmt::format("give a list of points{}, such as [[0, 0], [1, 0]]", in_unit(unit)));
      return;
    }
    std::vector<Coordinates> given;
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (auto corner = point(key, fmt::format("{}[{}]", key, i), (*list)[i], unit)) {
        given.push_back(std::move(*corner));
      }
    }
    value = std::move(given);
  }

  void numbers(std::string_view key, std::vector<double>& value, std::string_view unit, std::string_view doc) {
    const toml::node* node = find(key, doc, unit, "", Presence::optional);
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      wrong(key, *node, fmt::format("give a list of numbers{}, such as [0.5, 1.0]", in_unit(unit)));
      return;
    }
    if (auto given = elements(key, std::string(key), *list, unit)) {
      value = std::move(*given);
    }
  }

  void texts(std::string_view key, std::vector<std::string>& value, std::span<const std::string_view> allowed,
             std::string_view doc) {
    const toml::node* node = find(key, doc, "", quoted_list(allowed), Presence::optional);
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      wrong(key, *node, fmt::format("give a list of any of {}", quoted_list(allowed)));
      return;
    }
    std::vector<std::string> given;
    for (std::size_t i = 0; i < list->size(); ++i) {
      const toml::node& element = (*list)[i];
      const std::string place = fmt::format("{}[{}]", key, i);
      const auto* name = element.as_string();
      if (name == nullptr) {
        wrong(key, element, fmt::format("give any of {}", quoted_list(allowed)), place);
      } else if (std::find(allowed.begin(), allowed.end(), name->get()) == allowed.end()) {
        wrong(key, element, fmt::format("unknown name; {}", unknown_name_hint(name->get(), allowed)), place);
      } else if (std::find(given.begin(), given.end(), name->get()) != given.end()) {
        wrong(key, element, "stands in the list twice; remove one", place);
      } else {
        given.push_back(name->get());
      }
    }
    value = std::move(given);
  }

  template <class Enumeration>
  void choice(std::string_view key, Enumeration& value, std::string_view doc, Presence presence = Presence::optional) {
    constexpr auto& names = Choices<Enumeration>::names;
    const toml::node* node = find(key, doc, "", quoted_list(names), presence);
    if (node == nullptr) {
      return;
    }
    const auto* name = node->as_string();
    if (name == nullptr) {
      wrong(key, *node, fmt::format("give one of {}", quoted_list(names)));
      return;
    }
    const auto found = std::find(names.begin(), names.end(), name->get());
    if (found == names.end()) {
      wrong(key, *node, fmt::format("unknown choice; {}", unknown_name_hint(name->get(), names)));
    } else {
      value = static_cast<Enumeration>(found - names.begin());
    }
  }

  /// Reads just these keys now, because the others' defaults or meaning depend on them.
  template <class Table>
  void read_ahead(Table& table, std::initializer_list<std::string_view> keys) {
    only_ = keys;
    Table::describe(table, *this);
    only_.clear();
    for (const std::string_view key : keys) {
      context_.keys_done.insert(full(key));
    }
  }

  const toml::node* given(std::string_view key) const { return source_ == nullptr ? nullptr : source_->get(key); }
  bool is_wrong(std::string_view key) const { return context_.keys_wrong.contains(full(key)); }
  int dimension() const { return context_.dimension; }
  const toml::table* source() const { return source_; }

  /// A problem of the value of `key`, or of the part of it at `place`.
  void wrong(std::string_view key, const toml::node& node, const std::string& message, std::string_view place = "") {
    context_.keys_wrong.insert(full(key));
    context_.problems.add(context_.file, &node.source(),
                          fmt::format("{} = {}: {}", full(place.empty() ? key : place), value_text(node), message));
  }

  /// A key that should be there.
  void missing(std::string_view key, const std::string& message) {
    context_.keys_wrong.insert(full(key));
    context_.problems.add(context_.file, source_ == nullptr ? nullptr : &source_->source(),
                          fmt::format("{} is missing; {}", full(key), message));
  }

  /// Keys in the file that the table does not have.
  void report_unknown_keys(std::span<const KeyInfo> keys) {
    if (source_ == nullptr) {
      return;
    }
    std::vector<std::string_view> valid;
    for (const KeyInfo& info : keys) {
      valid.push_back(info.key);
    }
    for (const auto& [key, node] : *source_) {
      if (std::find(valid.begin(), valid.end(), key.str()) == valid.end()) {
        wrong(key.str(), node,
              fmt::format("unknown key; {}{}", home_of(key.str()), unknown_name_hint(key.str(), valid)));
      }
    }
  }

 private:
  std::string full(std::string_view key) const { return fmt::format("{}.{}", name_, key); }

  /// The value given for a key; null if it was read ahead or is absent. Reports it if it is required.
  const toml::node* find(std::string_view key, std::string_view doc, std::string_view unit, std::string_view allowed,
                         Presence presence) {
    const bool is_not_now = !only_.empty() && std::find(only_.begin(), only_.end(), key) == only_.end();
    if (is_not_now || context_.keys_done.contains(full(key))) {
      return nullptr;
    }
    const toml::node* node = given(key);
    if (node == nullptr && presence == Presence::required) {
      missing(key, fmt::format("add {} = ... to the table: {}{}{}{}", key, doc, allowed.empty() ? "" : "; ", allowed,
                               in_unit(unit)));
    }
    return node;
  }

  /// The number that a node of `key` stands for, if it is one.
  std::optional<double> evaluated(std::string_view key, std::string_view place, const toml::node& node,
                                  std::string_view unit) {
    std::optional<double> value = node.value<double>();
    if (const auto* text = node.as_string()) {
      try {
        value = evaluate(text->get(), context_.numbers);
      } catch (const ExpressionError& error) {
        wrong(key, node, error.what(), place);
        return std::nullopt;
      }
      if (!std::isfinite(*value)) {
        // It uses a number that has no value itself, which is reported where that number stands.
        context_.keys_wrong.insert(full(key));
        return std::nullopt;
      }
    } else if (!node.is_number()) {
      wrong(key, node, fmt::format("wrong type; give a number{} or an expression such as \"2*H\"", in_unit(unit)),
            place);
      return std::nullopt;
    }
    if (!std::isfinite(*value)) {
      wrong(key, node, fmt::format("not a finite number; give a number{}", in_unit(unit)), place);
      return std::nullopt;
    }
    return value;
  }

  std::optional<std::vector<double>> elements(std::string_view key, const std::string& place, const toml::array& list,
                                              std::string_view unit) {
    std::vector<double> values;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (const auto value = evaluated(key, fmt::format("{}[{}]", place, i), list[i], unit)) {
        values.push_back(*value);
      }
    }
    return values.size() == list.size() ? std::optional(values) : std::nullopt;
  }

  std::optional<Coordinates> point(std::string_view key, const std::string& place, const toml::node& node,
                                   std::string_view unit) {
    const toml::array* list = node.as_array();
    const int dimension = context_.dimension;
    const bool is_right_size =
        list != nullptr &&
        (dimension == 0 ? list->size() == 2 || list->size() == 3 : list->size() == static_cast<std::size_t>(dimension));
    if (!is_right_size) {
      const std::string count = dimension == 0 ? "2 or 3" : fmt::format("{}", dimension);
      wrong(key, node,
            fmt::format("give {} numbers{}, one per dimension{}", count, in_unit(unit),
                        dimension == 0 ? "" : fmt::format(" (case.dimension = {})", dimension)),
            place);
      return std::nullopt;
    }
    return elements(key, place, *list, unit);
  }

  Context& context_;
  const toml::table* source_;
  std::string name_;
  std::vector<std::string_view> only_;
};

// --- What single tables need beyond their keys ------------------------------------------------------------------

template <class Table>
void set_defaults(Table&, TableReader&) {}

void set_defaults(SchemeTable& scheme, TableReader& reader) {
  reader.read_ahead(scheme, {"formulation", "integrator"});
  apply_formulation(scheme);
}

void set_defaults(FluidTable& fluid, TableReader& reader) {
  fluid.velocity.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(WallTable& wall, TableReader& reader) {
  reader.read_ahead(wall, {"shape"});
  wall.fluid_side = wall.shape == WallShape::polyline ? FluidSide::left : FluidSide::inside;
}

void set_defaults(ProbeTable& probe, TableReader& reader) {
  reader.read_ahead(probe, {"type"});
  if (probe.type == ProbeType::front) {
    probe.direction.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
    if (!probe.direction.empty()) {
      probe.direction.front() = 1.0;
    }
  }
}

/// Checks that involve several keys of one table. Keys whose own value is wrong were reported and are left out.
template <class Table>
void check(const Table&, TableReader&) {}

void check_shape_dimension(std::string_view shape, bool is_planar, TableReader& reader) {
  const toml::node* node = reader.given("shape");
  if (!is_planar || reader.dimension() != 3) {
    return;
  }
  const std::string message =
      fmt::format("\"{}\" is a shape of two dimensions, but case.dimension = 3; use \"box\"", shape);
  if (node != nullptr) {
    reader.wrong("shape", *node, message);
  } else {
    reader.missing("shape", message);
  }
}

void check_box(const Coordinates& min, const Coordinates& max, TableReader& reader) {
  const toml::node* node = reader.given("max");
  if (node == nullptr || reader.given("min") == nullptr || reader.is_wrong("min") || reader.is_wrong("max")) {
    return;
  }
  for (std::size_t d = 0; d < std::min(min.size(), max.size()); ++d) {
    if (max[d] <= min[d]) {
      reader.wrong("max", *node,
                   fmt::format("the box has no extent in {}: {} to {}; give max above min", "xyz"[d], min[d], max[d]));
    }
  }
}

void check_corner_count(const std::vector<Coordinates>& points, std::size_t least, TableReader& reader) {
  const toml::node* node = reader.given("points");
  if (node != nullptr && !reader.is_wrong("points") && points.size() < least) {
    reader.wrong("points", *node,
                 fmt::format("{} points are too few for this shape; give at least {}", points.size(), least));
  }
}

void check(const FluidTable& fluid, TableReader& reader) {
  check_shape_dimension(name_of(fluid.shape), fluid.shape == BlockShape::polygon, reader);
  check_box(fluid.min, fluid.max, reader);
  check_corner_count(fluid.points, 3, reader);
}

void check(const WallTable& wall, TableReader& reader) {
  check_shape_dimension(name_of(wall.shape), wall.shape != WallShape::box, reader);
  check_box(wall.min, wall.max, reader);
  check_corner_count(wall.points, wall.shape == WallShape::polyline ? 2 : 3, reader);
  if (const toml::node* node = reader.given("open"); node != nullptr && reader.dimension() == 2) {
    for (const std::string& face : wall.open) {
      if (face.ends_with('z')) {
        reader.wrong("open", *node, fmt::format("a box of two dimensions has no face \"{}\"; remove it", face));
      }
    }
  }
  const bool is_chain = wall.shape == WallShape::polyline;
  const bool is_side_of_chain = wall.fluid_side == FluidSide::left || wall.fluid_side == FluidSide::right;
  if (is_chain != is_side_of_chain && !reader.is_wrong("shape") && !reader.is_wrong("fluid_side")) {
    reader.wrong("fluid_side", *reader.given("fluid_side"),
                 fmt::format("does not go with shape = \"{}\"; give {}", name_of(wall.shape),
                             is_chain ? "\"left\" or \"right\"" : "\"inside\" or \"outside\""));
  }
}

void check(const ProbeTable& probe, TableReader& reader) {
  if (const toml::node* node = reader.given("direction"); node != nullptr && !reader.is_wrong("direction")) {
    if (std::all_of(probe.direction.begin(), probe.direction.end(), [](double c) { return c == 0.0; })) {
      reader.wrong("direction", *node, "has length 0; give a direction such as [1, 0]");
    }
  }
  if (const toml::node* node = reader.given("times"); node != nullptr && !reader.is_wrong("times")) {
    const bool is_rising =
        std::adjacent_find(probe.times.begin(), probe.times.end(), std::greater_equal<>()) == probe.times.end();
    if (probe.times.empty() || probe.times.front() < 0.0 || !is_rising) {
      reader.wrong("times", *node, "give at least one time in s, from 0 on, in rising order");
    }
  }
  const bool has_stretch = !probe.from.empty() && probe.from == probe.to;
  if (has_stretch && !reader.is_wrong("from") && !reader.is_wrong("to")) {
    reader.wrong("to", *reader.given("to"), "is the same point as from; give two points");
  }
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (const toml::node* node = reader.given("name"); node != nullptr && !reader.is_wrong("name")) {
    const bool is_file_name = std::all_of(probe.name.begin(), probe.name.end(), is_plain) && !probe.name.empty() &&
                              probe.name.front() != '-' && probe.name.size() <= 100;
    if (!is_file_name) {
      reader.wrong("name", *node,
                   "cannot name a file; use up to 100 letters, digits, _ and -, and do not begin with -");
    }
  }
}

void check(const DomainTable& domain, TableReader& reader) {
  const auto check_period = [&](std::string_view key, const std::vector<double>& range, int least_dimension) {
    const toml::node* node = reader.given(key);
    if (node == nullptr || reader.is_wrong(key) || range.empty()) {
      return;
    }
    if (range.size() != 2) {
      reader.wrong(key, *node, "give two numbers in m, [low, high], or remove the key");
    } else if (range[0] >= range[1]) {
      reader.wrong(key, *node, "is empty; give [low, high] with low below high, in m");
    } else if (reader.dimension() != 0 && reader.dimension() < least_dimension) {
      reader.wrong(key, *node, "a case of two dimensions has no z; remove the key");
    }
  };
  check_period("periodic_x", domain.periodic_x, 2);
  check_period("periodic_y", domain.periodic_y, 2);
  check_period("periodic_z", domain.periodic_z, 3);
}

/// Keys that the chosen shape or type needs, or has no use for.
void check_key_uses(std::string_view table, std::span<const KeyInfo> rows, TableReader& reader) {
  for (const KeyInfo& info : rows) {
    const auto [need, use] = key_verdict(table, info.key, rows);
    if (use == nullptr || reader.is_wrong(use->selector)) {
      continue;
    }
    const std::string choice = fmt::format("{} = \"{}\"", use->selector, use->choice);
    const toml::node* node = reader.given(info.key);
    if (need == KeyNeed::needed && node == nullptr) {
      reader.missing(info.key, fmt::format("{} needs it: {}{}", choice, info.doc, in_unit(info.unit)));
    } else if (need == KeyNeed::unused && node != nullptr) {
      reader.wrong(
          info.key, *node,
          fmt::format("has no use with {}; remove it (it goes with {})", choice, key_use_text(table, info.key)));
    }
  }
}

/// Blocks, walls and probes are told apart by their names.
template <class Table>
void check_names(const std::vector<Table>& tables, std::vector<TableReader>& readers) {
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (tables[i].name == tables[j].name && !tables[i].name.empty()) {
        const std::string message = fmt::format("the name \"{}\" is taken; give each its own", tables[i].name);
        const bool is_given = readers[i].given("name") != nullptr;
        TableReader& reader = is_given ? readers[i] : readers[j];
        reader.wrong("name", *reader.given("name"), message);
        break;
      }
    }
  }
}

// --- The whole case ---------------------------------------------------------------------------------------------

/// The table of that name; null if there is none or it is something else, which `CaseReader` reports.
const toml::table* find_table(const toml::table& root, std::string_view name) { return root[name].as_table(); }

/// Visitor for CaseSpec::describe.
class CaseReader {
 public:
  CaseReader(Context& context, const toml::table& root) : context_(context), root_(root) {}

  template <class Table>
  void table(std::string_view name, Table& table, std::string_view) {
    names_.push_back(name);
    if (const toml::node* node = root_.get(name); node != nullptr && !node->is_table()) {
      report(*node, name, fmt::format("not a table; write its keys below a line [{}]", name));
    }
    TableReader reader(context_, find_table(root_, name), std::string(name));
    read(name, table, reader);
  }

  template <class Table>
  void tables(std::string_view name, std::vector<Table>& tables, std::string_view) {
    names_.push_back(name);
    const toml::node* node = root_.get(name);
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    const bool are_tables =
        list != nullptr && std::all_of(list->begin(), list->end(), [](const toml::node& n) { return n.is_table(); });
    if (!are_tables) {
      report(*node, name, fmt::format("not a list of tables; write each below a line [[{}]] (two brackets)", name));
      return;
    }
    std::vector<TableReader> readers;
    tables.resize(list->size());
    for (std::size_t i = 0; i < list->size(); ++i) {
      readers.emplace_back(context_, (*list)[i].as_table(), fmt::format("{}[{}]", name, i));
      read(name, tables[i], readers.back());
      if (tables[i].name.empty() && !std::is_same_v<Table, ProbeTable>) {
        tables[i].name = default_name(std::string(name), i);
      }
    }
    check_names(tables, readers);
  }

  void report_unknown_tables() {
    for (const auto& [name, node] : root_) {
      if (std::find(names_.begin(), names_.end(), name.str()) == names_.end()) {
        report(node, name.str(), fmt::format("unknown table; {}", unknown_name_hint(name.str(), names_)));
      }
    }
  }

  /// [parameters]: each may use the others, in any order.
  void parameters(std::vector<Parameter>& parameters);

 private:
  template <class Table>
  void read(std::string_view name, Table& table, TableReader& reader) {
    set_defaults(table, reader);
    Table::describe(table, reader);
    const auto rows = keys_of(table);
    reader.report_unknown_keys(rows);
    check_key_uses(name, rows, reader);
    check(table, reader);
  }

  void report(const toml::node& node, std::string_view key, const std::string& message) {
    context_.problems.add(context_.file, &node.source(), fmt::format("{} = {}: {}", key, value_text(node), message));
  }

  /// True if the node has a value or can never have one; false if it waits for other parameters.
  bool settle(const std::string& name, const toml::node& node, const std::set<std::string>& waiting);

  Context& context_;
  const toml::table& root_;
  std::vector<std::string_view> names_;
};

bool CaseReader::settle(const std::string& name, const toml::node& node, const std::set<std::string>& waiting) {
  const std::string key = fmt::format("parameters.{}", name);
  // Until it has a value, what uses this parameter is not a number and is not reported a second time.
  double value = std::numeric_limits<double>::quiet_NaN();
  if (!is_free_name(name) || name == "dx" || name == "g") {
    report(node, key, "cannot be a parameter's name; use letters, digits and _, not dx, g, pi or a function's name");
    return true;
  }
  if (const auto* text = node.as_string()) {
    try {
      value = evaluate(text->get(), context_.numbers);
    } catch (const ExpressionError& error) {
      if (error.unknown_name() && waiting.contains(*error.unknown_name())) {
        return false;
      }
      report(node, key, error.what());
    }
  } else if (node.is_number() && std::isfinite(*node.value<double>())) {
    value = *node.value<double>();
  } else {
    report(node, key, "not a finite number; give a number or an expression of other parameters");
  }
  context_.numbers[name] = value;
  return true;
}

void CaseReader::parameters(std::vector<Parameter>& parameters) {
  names_.push_back("parameters");
  const toml::node* node = root_.get("parameters");
  if (node == nullptr) {
    return;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    report(*node, "parameters", "not a table; write the parameters below a line [parameters]");
    return;
  }
  std::set<std::string> waiting;
  for (const auto& [name, value] : *table) {
    waiting.emplace(name.str());
  }
  for (bool is_progress = true; is_progress;) {
    const std::size_t settled =
        std::erase_if(waiting, [&](const std::string& name) { return settle(name, *table->get(name), waiting); });
    is_progress = settled > 0;
  }
  for (const std::string& name : waiting) {
    report(*table->get(name), fmt::format("parameters.{}", name),
           "uses itself by way of other parameters; give one of them a number");
    context_.numbers[name] = std::numeric_limits<double>::quiet_NaN();
  }
  for (const auto& [name, value] : context_.numbers) {
    parameters.push_back({name, value});
  }
}

/// The few keys that all others depend on: the dimension, the parameters, dx and g, in this order.
void read_foundations(CaseSpec& spec, Context& context, CaseReader& reader, const toml::table& root) {
  TableReader general(context, find_table(root, "case"), "case");
  general.read_ahead(spec.general, {"dimension"});
  context.dimension = general.is_wrong("dimension") ? 0 : spec.general.dimension;

  reader.parameters(spec.parameters);

  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  TableReader particles(context, find_table(root, "particles"), "particles");
  particles.read_ahead(spec.particles, {"spacing"});
  context.numbers["dx"] = particles.is_wrong("spacing") ? unknown : spec.particles.spacing;

  TableReader physics(context, find_table(root, "physics"), "physics");
  if (context.dimension == 3) {
    spec.physics.gravity = {0.0, 0.0, -9.81};
  }
  physics.read_ahead(spec.physics, {"gravity"});
  double magnitude = 0.0;
  for (const double component : spec.physics.gravity) {
    magnitude = std::hypot(magnitude, component);
  }
  context.numbers["g"] = physics.is_wrong("gravity") ? unknown : magnitude;
}

std::string read_text(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw IoError(fmt::format("{}: is a folder; give the case file in it", path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw IoError(fmt::format("{}: cannot read the case file ({}); check the path, or start one with `tailwater new`",
                              path.string(), std::generic_category().message(errno)));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

toml::table parse(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: not valid TOML: {}; correct the line (texts stand in quotes, lists in [ ])",
                                 file, where.line, where.column, error.description()));
  }
}

}  // namespace

CaseSpec read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  Context context;
  context.file = path.string();
  toml::table root = parse(read_text(path), context.file);
  for (const std::string& problem : apply_overrides(root, overrides)) {
    context.problems.add_override(problem);
  }
  CaseSpec spec;
  CaseReader reader(context, root);
  read_foundations(spec, context, reader, root);
  CaseSpec::describe(spec, reader);
  reader.report_unknown_tables();
  if (root.get("fluid") == nullptr || (root["fluid"].is_array() && spec.fluid.empty())) {
    context.problems.add(context.file, nullptr, "there is no fluid; add at least one table [[fluid]]");
  }
  if (!context.problems.none()) {
    throw InputError(context.problems.text());
  }
  return spec;
}

}  // namespace tailwater
