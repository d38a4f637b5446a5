#include "case/reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/error.h"
#include "case/across_tables.h"
#include "case/case_toml.h"
#include "case/driven_walls.h"
#include "case/expression.h"
#include "case/measurements.h"
#include "case/named_numbers.h"
#include "case/nearest_name.h"
#include "case/overrides.h"
#include "case/problems.h"
#include "case/table_reader.h"
#include "case/table_rules.h"

namespace tailwater {

namespace {

/// Names of blocks, walls, outlets and probes must differ.
template <class Table>
void check_names(const std::vector<Table>& tables, std::vector<TableReader>& readers) {
  std::map<std::string_view, std::size_t> first_with;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i].name.empty()) continue;
    const auto [first, is_new] = first_with.emplace(tables[i].name, i);
    if (is_new) continue;
    const std::string message =
        fmt::format("the name \"{}\" is used twice; give each table a name of its own", tables[i].name);
    const bool is_given = readers[i].given("name") != nullptr;
    TableReader& reader = is_given ? readers[i] : readers[first->second];
    reader.wrong("name", *reader.given("name"), message);
  }
}

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
    if (node == nullptr) return;
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
    read_linked_files(table, reader);
  }

  void report(const toml::node& node, std::string_view key, const std::string& message) {
    context_.problems.add(&node.source(), fmt::format("{} = {}: {}", key, value_text(node), message));
  }

  /// Gives the parameter its value, or reports why it can never have one; returns the parameter in `open` that it waits
  /// for, if it does.
  std::optional<std::string> settle(const std::string& name, const toml::node& node, const std::set<std::string>& open);

  Context& context_;
  const toml::table& root_;
  std::vector<std::string_view> names_;
};

std::optional<std::string> CaseReader::settle(const std::string& name, const toml::node& node,
                                              const std::set<std::string>& open) {
  const std::string key = fmt::format("parameters.{}", name);
  // Until it has a value, what uses this parameter is not a number and is not reported a second time.
  double value = std::numeric_limits<double>::quiet_NaN();
  const bool is_position = std::find(position_names.begin(), position_names.end(), name) != position_names.end();
  if (!is_free_name(name) || is_position || name == time_name[0] || name == "dx" || name == "g") {
    report(node, key,
           "cannot be a parameter's name; use letters, digits and _, not x, y, z, t, dx, g, pi or a function's name");
    return std::nullopt;
  }
  if (const auto* text = node.as_string()) {
    try {
      value = evaluate(text->get(), context_.numbers);
    } catch (const ExpressionError& error) {
      if (error.unknown_name() && open.contains(*error.unknown_name())) return error.unknown_name();
      report(node, key, error.what());
    }
  } else if (const auto number = number_in(node); node.is_number() && std::isfinite(*number)) {
    value = *number;
  } else {
    report(node, key, "not a finite number; give a number or an expression of other parameters");
  }
  context_.numbers[name] = value;
  return std::nullopt;
}

void CaseReader::parameters(std::vector<Parameter>& parameters) {
  names_.push_back("parameters");
  const toml::node* node = root_.get("parameters");
  if (node == nullptr) return;
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    report(*node, "parameters", "not a table; write the parameters below a line [parameters]");
    return;
  }
  constexpr std::size_t most = 1000;  // their names are compared with each unknown one
  if (table->size() > most) {
    report(*node, "parameters", fmt::format("has {} parameters; a case has at most {}", table->size(), most));
    return;
  }
  std::set<std::string> open;
  for (const auto& [name, value] : *table) open.emplace(name.str());
  std::vector<std::string> next(open.begin(), open.end());
  std::map<std::string, std::vector<std::string>> waiting_for;
  while (!next.empty()) {
    const std::string name = next.back();
    next.pop_back();
    if (const auto other = settle(name, *table->get(name), open)) {
      waiting_for[*other].push_back(name);
      continue;
    }
    open.erase(name);
    const std::vector<std::string>& waiting = waiting_for[name];
    next.insert(next.end(), waiting.begin(), waiting.end());
  }
  for (const std::string& name : open) {
    report(*table->get(name), fmt::format("parameters.{}", name),
           "depends on itself through other parameters; give one of them a number");
    context_.numbers[name] = std::numeric_limits<double>::quiet_NaN();
  }
  for (const auto& [name, value] : context_.numbers) {
    parameters.push_back({name, value});
  }
}

/// Reads the few keys that all others depend on: the dimension, the parameters, dx and g, in this order.
void read_foundations(CaseSpec& spec, Context& context, CaseReader& reader, const toml::table& root) {
  TableReader general(context, find_table(root, "case"), "case");
  general.read_ahead(spec.general, {"format", "dimension"});
  if (spec.general.format > case_format) {
    // What else seems wrong may be right in that format.
    general.wrong("format", *general.given("format"),
                  fmt::format("this program reads case files up to format {}; use a newer version of it", case_format));
    throw InputError(context.problems.text());
  }
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
  context.numbers["g"] = physics.is_wrong("gravity") ? unknown : gravity_magnitude(spec.physics);
}

/// Where the tables and keys are that messages about shapes, probes and steps name.
CaseSources find_sources(const CaseSpec& spec, const toml::table& root, const std::string& file) {
  CaseSources sources;
  const auto add_keys = [&](const toml::table& table, const std::string& start) {
    for (const auto& [key, node] : table) sources.add(start + std::string(key.str()), place_text(file, &node.source()));
  };
  const auto add_tables = [&](std::string_view name, const auto& tables) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const toml::table* table = root[name][i].as_table();
      const std::string label = fmt::format("{} '{}'", name, tables[i].name);
      sources.add(label, place_text(file, &table->source()));
      add_keys(*table, label + ": ");
    }
  };
  add_tables("pocket", spec.pockets);
  add_tables("vent", spec.vents);
  add_tables("fluid", spec.fluid);
  add_tables("wall", spec.walls);
  add_tables("gate", spec.gates);
  add_tables("wave_maker", spec.wave_makers);
  add_tables("body", spec.bodies);
  add_tables("mooring", spec.moorings);
  add_tables("damping", spec.damping);
  add_tables("inlet", spec.inlets);
  add_tables("outlet", spec.outlets);
  add_tables("probe", spec.probes);
  add_tables("measurement", spec.measurements);
  for (const auto& [name, node] : root) {
    if (const toml::table* table = node.as_table()) add_keys(*table, fmt::format("{}.", name.str()));
  }
  return sources;
}

/// `folder`: that of the case, for files it names.
CaseSpec read_case_in(const std::filesystem::path& folder, std::string_view text, const std::string& origin,
                      const std::vector<std::string>& overrides) {
  Context context(origin, folder);
  toml::table root = parse_case(text, origin);
  for (const std::string& problem : apply_overrides(root, overrides)) context.problems.add_override(problem);
  CaseSpec spec;
  CaseReader reader(context, root);
  read_foundations(spec, context, reader, root);
  CaseSpec::describe(spec, reader);
  reader.report_unknown_tables();
  const bool has_no_fluid = root.get("fluid") == nullptr || (root["fluid"].is_array() && spec.fluid.empty());
  if (has_no_fluid && root.get("inlet") == nullptr) {
    context.problems.add(nullptr, "there is no fluid; add at least one table [[fluid]], or an [[inlet]]");
  }
  if (context.problems.none()) check_across_tables(spec, root, context.problems);
  if (context.problems.none()) read_measurements(spec, root, context.problems);
  if (!context.problems.none()) throw InputError(context.problems.text());
  spec.sources = find_sources(spec, root, origin);
  append_driven_walls(spec);
  return spec;
}

}  // namespace

CaseSpec read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read_case_in(path.parent_path(), read_case_file(path, largest_case_file), path.string(), overrides);
}

CaseSpec read_effective_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read_case_in(path.parent_path(), read_case_file(path, largest_effective_case), path.string(), overrides);
}

CaseSpec read_case_text(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides,
                        const std::filesystem::path& folder) {
  return read_case_in(folder, text, origin, overrides);
}

}  // namespace tailwater
