#include "case/reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "base/error.h"
#include "case/expression.h"
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
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (tables[i].name == tables[j].name && !tables[i].name.empty()) {
        const std::string message =
            fmt::format("the name \"{}\" is used twice; give each table a name of its own", tables[i].name);
        const bool is_given = readers[i].given("name") != nullptr;
        TableReader& reader = is_given ? readers[i] : readers[j];
        reader.wrong("name", *reader.given("name"), message);
        break;
      }
    }
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
    context_.problems.add(&node.source(), fmt::format("{} = {}: {}", key, value_text(node), message));
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
  const bool is_position = std::find(position_names.begin(), position_names.end(), name) != position_names.end();
  if (!is_free_name(name) || is_position || name == time_name[0] || name == "dx" || name == "g") {
    report(node, key,
           "cannot be a parameter's name; use letters, digits and _, not x, y, z, t, dx, g, pi or a function's name");
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
  context.numbers["g"] = physics.is_wrong("gravity") ? unknown : gravity_magnitude(spec.physics);
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

toml::table parse(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position where = error.source().begin;
    throw InputError(
        fmt::format("{}:{}:{}: not valid TOML: {}; correct the line (texts are written in quotes, lists in [ ])", file,
                    where.line, where.column, error.description()));
  }
}

}  // namespace

CaseSpec read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read_case_text(read_text(path), path.string(), overrides);
}

CaseSpec read_case_text(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides) {
  Context context(origin);
  toml::table root = parse(text, origin);
  for (const std::string& problem : apply_overrides(root, overrides)) {
    context.problems.add_override(problem);
  }
  CaseSpec spec;
  CaseReader reader(context, root);
  read_foundations(spec, context, reader, root);
  CaseSpec::describe(spec, reader);
  reader.report_unknown_tables();
  if (root.get("fluid") == nullptr || (root["fluid"].is_array() && spec.fluid.empty())) {
    context.problems.add(nullptr, "there is no fluid; add at least one table [[fluid]]");
  }
  if (!context.problems.none()) {
    throw InputError(context.problems.text());
  }
  return spec;
}

}  // namespace tailwater
