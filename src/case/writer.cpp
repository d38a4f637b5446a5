#include "case/writer.h"

#include <fmt/format.h>

#include <type_traits>

#include "case/driven_walls.h"
#include "case/key_info.h"
#include "case/key_use.h"

namespace tailwater {

namespace {

/// Visitor for CaseSpec::describe.
class CaseWriter {
 public:
  CaseWriter(std::string& text, const SchemeTable& scheme) : text_(text), scheme_(scheme) {}

  template <class Table>
  void table(std::string_view name, const Table& table, std::string_view doc) {
    if (std::is_same_v<Table, StudyTable> && table == Table{}) return;  // no study
    text_ += fmt::format("\n# {}\n[{}]\n", doc, name);
    write(name, keys_of(table));
  }

  template <class Table>
  void tables(std::string_view name, const std::vector<Table>& tables, std::string_view doc) {
    for (const Table& table : tables) {
      if constexpr (std::is_same_v<Table, WallTable>) {
        if (!is_own_table(table)) continue;  // the table that drives it is written
      }
      text_ += fmt::format("\n# {}\n[[{}]]\n", doc, name);
      write(name, keys_of(table));
    }
  }

 private:
  void write(std::string_view name, const std::vector<KeyInfo>& rows) {
    for (const KeyInfo& row : rows) {
      if (name == "study" && !has_study(scheme_, row.key)) continue;
      // Vectors that are not given have no default; the reader rejects a key without numbers.
      const bool has_value = row.value != "[]" || (row.type != "vector" && row.type != "points");
      if (has_value && key_verdict(name, row.key, rows).need != KeyNeed::unused) {
        const std::string unit = row.unit.empty() ? "" : fmt::format("{}: ", row.unit);
        text_ += fmt::format("{} = {}  # {}{}\n", row.key, row.value, unit, row.doc);
      }
    }
  }

  std::string& text_;
  const SchemeTable& scheme_;
};

}  // namespace

std::string effective_case(const CaseSpec& spec) {
  std::string text = "# The case as it was run: every key that applies, with its value in SI units.\n";
  if (!spec.parameters.empty()) {
    text += "\n# Named numbers for use in expressions\n[parameters]\n";
    for (const Parameter& parameter : spec.parameters) {
      text += fmt::format("{} = {}\n", parameter.name, toml_float(parameter.value));
    }
  }
  CaseWriter writer(text, spec.scheme);
  CaseSpec::describe(spec, writer);
  return text;
}

}  // namespace tailwater
