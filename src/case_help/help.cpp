#include "case_help/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "case/expression.h"
#include "case/formulation.h"
#include "case/key_info.h"
#include "case/key_use.h"

namespace tailwater {

namespace {

/// Tables that no case needs: the reference does not list them.
bool is_for_studies(const TableInfo& table) {
  return table.name == "study" || table.name == "parallel" || table.name == "limits";
}

/// The default of the Courant number with each formulation.
std::string courant_text() {
  const auto text = [](SchemeName name, Formulation formulation,
                       Integrator integrator = Integrator::explicit_projection) {
    SchemeTable scheme{.name = name, .formulation = formulation, .integrator = integrator};
    apply_formulation(scheme);
    return toml_float(scheme.courant);
  };
  constexpr auto robust = Formulation::robust;
  constexpr auto published = Formulation::published;
  return fmt::format("{} (published: {}, implicit {}; farmani2020: {}, published {})",
                     text(SchemeName::farzin2014, robust), text(SchemeName::farzin2014, published),
                     text(SchemeName::farzin2014, published, Integrator::implicit_projection),
                     text(SchemeName::farmani2020, robust), text(SchemeName::farmani2020, published));
}

std::string default_text(const TableInfo& table, const KeyInfo& row) {
  if (row.presence == Presence::required) return "required";
  if (row.value == "[]" || row.value == "\"\"") return "";
  return table.name == "scheme" && row.key == "courant" ? courant_text() : row.value;
}

std::string type_text(const KeyInfo& row) {
  if (row.type == "vector") return "list of `dimension` numbers";
  if (row.type == "points") return "list of points";
  if (row.type == "numbers") return "list of numbers";
  if (row.type == "texts") return "name or list of names";
  return row.type;
}

/// A cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '|') escaped += '\\';
    escaped += letter;
  }
  return escaped;
}

std::string functions_text() { return fmt::format("{}", fmt::join(function_names(), ", ")); }

/// The text with its lines broken at spaces where they would exceed 120 characters; items of a list stay indented.
std::string wrapped(const std::string& text) {
  constexpr std::size_t width = 120;
  std::string result;
  std::size_t line = 0;  // where the current line begins in `result`
  for (const char c : text) {
    result += c;
    if (c == '\n') line = result.size();
    if (result.size() - line <= width) continue;
    const std::string indent = result.compare(line, 2, "- ") == 0 || result.compare(line, 2, "  ") == 0 ? "  " : "";
    const std::size_t space = result.rfind(' ');
    result.replace(space, 1, "\n" + indent);
    line = space + 1;
  }
  return result;
}

/// A table of keys as a table of the page.
std::string markdown_of(const TableInfo& table) {
  std::string text = fmt::format("\n### {}\n\n{}.\n\n", table.heading(), table.doc);
  text += "| key | type | default | unit | range | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const KeyInfo& row : table.keys) {
    if (row.presence == Presence::written) continue;
    const std::string use = key_use_text(table.name, row.key);
    text += fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", row.key, type_text(row), default_text(table, row),
                        row.unit, row.allowed, cell(row.doc), use.empty() ? "" : fmt::format(". *Goes with* {}", use));
  }
  return text;
}

}  // namespace

std::string case_help() {
  std::string text =
      "A case file is TOML. Numbers are SI, or expressions in quotes such as \"2*H\" of the names in [parameters],\n"
      "of pi, dx (particles.spacing) and g (|physics.gravity|).\n"
      "Functions: " +
      functions_text() + "\n";
  for (const TableInfo& table : case_tables()) {
    text += fmt::format("\n{}  {}\n", table.heading(), table.doc);
    for (const KeyInfo& row : table.keys) {
      if (row.presence == Presence::written) continue;
      const std::string fallback = default_text(table, row);
      const std::string use = key_use_text(table.name, row.key);
      text += fmt::format("  {} ({}{}{})\n", row.key, row.type, row.unit.empty() ? "" : fmt::format(", {}", row.unit),
                          row.presence == Presence::required ? ", required"
                          : fallback.empty()                 ? ""
                                                             : fmt::format(", default {}", fallback));
      text += fmt::format("      {}\n", row.doc);
      if (!row.allowed.empty()) {
        text += fmt::format("      allowed: {}\n", row.allowed);
      }
      if (!use.empty()) {
        text += fmt::format("      goes with {}\n", use);
      }
    }
  }
  return text;
}

std::string case_reference_markdown() {
  std::string text = wrapped(
      "# The case file\n\n"
      "For users who look up a table or a key. `tailwater run --help-case=markdown > docs/reference/case-file.md` "
      "writes this page; change `src/case/spec.h` instead.\n\n"
      "[examples.md](examples.md) shows each table in a case, with a picture and its output.\n\n"
      "A case file is [TOML](https://toml.io). Unknown keys are errors, and all problems of a file are reported at "
      "once.\n\n"
      "## Numbers\n\n"
      "Numbers are SI, without units. Any number, also one in a list, may be written as an expression in quotes:\n\n"
      "```toml\n# append to a case\n[parameters]\nH = 0.6\nL = \"2*H\"\n\n"
      "[[fluid]]\nmin = [0, 0]\nmax = [\"L\", \"H\"]\n```\n\n"
      "- operators: `+ - * / ^` and parentheses; `^` binds tighter than the sign, `-2^2` is -4; `a < b ? c : d` is c "
      "or d\n"
      "- names: the keys of `[parameters]` (letters, digits, `_`), `pi`, `dx` = `particles.spacing`, `g` = the "
      "magnitude of `physics.gravity`, which may use one another in any order; in `fluid.velocity` also `x`, `y`, `z`, "
      "the particle's position, and in what varies with time (such as `wall.displacement` and `inlet.discharge`) the "
      "time `t`; none of these can name a parameter. In the `level` of an opening `q` is its discharge; the case "
      "must not have a parameter `q` then\n"
      "- functions: " +
      functions_text() +
      "; `log` and `ln` are natural logarithms\n\n"
      "## Changes from the command line\n\n"
      "`--set key=value` replaces or adds one value: `--set scheme.integrator=implicit`, `--set parameters.H=0.5`, "
      "`--set 'fluid[0].max=[1, 2]'` (tables count from 0), `--set probe.NAME.interval=0.01`. Words and expressions "
      "need no quotes.\n\n"
      "## Tables\n\n"
      "`[name]` appears once, `[[name]]` any number of times. *Goes with* names the shapes or types that a key belongs "
      "to; with any other the key is an error.\n\n"
      "The case that a run writes beside its results also has the `checksum` of each file that it names, and is "
      "refused with another file.\n");
  for (const TableInfo& table : case_tables()) {
    if (!is_for_studies(table)) text += markdown_of(table);
  }
  return text;
}

std::string study_reference_markdown() {
  std::string text = wrapped(
      "# Keys for studies\n\n"
      "For researchers who measure the effect of one term of the method. `tailwater run --help-case=study > "
      "docs/reference/study-keys.md` writes this page; change `src/case/spec.h` instead.\n\n"
      "The keys of [study] change parts of the robust formulations, so that a study can show the effect of each "
      "([devices.md](../theory/devices.md)). No user needs them. The "
      "[reference](case-file.md) does not list them, and the published formulations have none of them. [limits] sets "
      "the errors of energy and volume at which a run "
      "warns or stops; [parallel] is for measurements of runs on several ranks.\n");
  for (const TableInfo& table : case_tables()) {
    if (is_for_studies(table)) text += markdown_of(table);
  }
  return text;
}

}  // namespace tailwater
