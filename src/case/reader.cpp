#include "case/reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>

#include "case/across_tables.h"
#include "case/case_toml.h"
#include "case/driven_walls.h"
#include "case/foundations.h"
#include "case/measurements.h"
#include "case/nearest_name.h"
#include "case/overrides.h"
#include "case/problems.h"
#include "case/rheology.h"
#include "case/table_reader.h"
#include "case/table_rules.h"

namespace tailwater {

namespace {

/// Checks that names of blocks, walls, outlets and probes differ.
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
    reader.wrong("name-twice", "name", *reader.given("name"), message);
  }
}

/// The table of that name; null if there is none or if it is something else, which `CaseReader` reports.
const toml::table* find_table(const toml::table& root, std::string_view name) { return root[name].as_table(); }

/// Visitor for CaseSpec::describe.
class CaseReader {
 public:
  CaseReader(Context& context, const toml::table& root, const std::string& file)
      : context_(context), root_(root), file_(file) {}

  template <class Table>
  void table(std::string_view name, Table& table, std::string_view) {
    names_.push_back(name);
    if (const toml::node* node = root_.get(name); node != nullptr && !node->is_table()) {
      context_.problems.wrong("table-expected", CaseLabel(std::string(name)), *node,
                              fmt::format("not a table; write its keys below a line [{}]", name));
    }
    const CaseLabel label{std::string(name)};
    const toml::table* source = find_table(root_, name);
    TableReader reader(context_, source, label);
    read(name, table, reader);
    if (source != nullptr) add_source(label, *source);
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
      context_.problems.wrong("table-list-expected", CaseLabel(std::string(name)), *node,
                              fmt::format("not a list of tables; write each below a line [[{}]] (two brackets)", name));
      return;
    }
    std::vector<TableReader> readers;
    tables.resize(list->size());
    for (std::size_t i = 0; i < list->size(); ++i) {
      readers.emplace_back(context_, (*list)[i].as_table(), CaseLabel(std::string(name), i));
      read(name, tables[i], readers.back());
      if (tables[i].name.empty() && !std::is_same_v<Table, ProbeTable>) {
        tables[i].name = default_name(std::string(name), i);
      }
      CaseLabel label(std::string(name), tables[i].name);
      label.index = static_cast<int>(i);
      add_source(label, *(*list)[i].as_table());
    }
    check_names(tables, readers);
  }

  void report_unknown_tables() {
    for (const auto& [name, node] : root_) {
      if (std::find(names_.begin(), names_.end(), name.str()) == names_.end()) {
        context_.problems.wrong(
            "table-unknown", CaseLabel(std::string(name.str())), node,
            fmt::format("unknown table; {}{}", home_of(name.str()), unknown_name_hint(name.str(), names_)));
      }
    }
  }

  CaseSources take_sources() { return std::move(sources_); }

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

  void add_source(const CaseLabel& label, const toml::table& table) {
    const FilePosition head = position_of(file_, &table.source());
    int last_line = head.line;
    for (const auto& [key, node] : table) {
      const FilePosition position = position_of(file_, &node.source());
      if (position.file == file_) last_line = std::max(last_line, static_cast<int>(node.source().end.line));
      sources_.add(label.with_key(key.str()), position);
    }
    sources_.add(label, head, last_line);
  }

  Context& context_;
  const toml::table& root_;
  const std::string& file_;
  CaseSources sources_;
  std::vector<std::string_view> names_{"parameters"};
};

/// `folder` is that of the case, for the files that it names.
CaseSpec read_case_in(const std::filesystem::path& folder, std::string_view text, const std::string& origin,
                      const std::vector<std::string>& overrides) {
  Context context(origin, folder);
  toml::table root = parse_case(text, origin);
  apply_overrides(root, overrides, context.problems);
  CaseSpec spec;
  read_foundations(spec, context, root);
  CaseReader reader(context, root, origin);
  CaseSpec::describe(spec, reader);
  reader.report_unknown_tables();
  const bool has_no_fluid = root.get("fluid") == nullptr || (root["fluid"].is_array() && spec.fluid.empty());
  const bool comes_in = root.get("inlet") != nullptr || std::ranges::any_of(spec.outlets, may_bring_water);
  if (has_no_fluid && !comes_in) {
    context.problems.add("no-fluid", nullptr, {},
                         "there is no fluid; add a [[fluid]] or an [[inlet]] table, or the level of an [[outlet]]");
  }
  if (context.problems.none()) {
    check_across_tables(spec, root, context.problems);
    read_measurements(spec, root, context.problems);
  }
  check_named_walls(spec, root, context.problems);
  if (!context.problems.none()) throw CaseError(context.problems.findings());
  if (const LiquidTable* const liquid = liquid_of(spec)) {
    spec.physics.density = liquid->density;
    spec.physics.viscosity = kinematic_viscosity(*liquid);
  }
  spec.sources = reader.take_sources();
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
