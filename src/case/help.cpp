#include "case/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "case/expression.h"
#include "case/formulation.h"
#include "case/key_info.h"
#include "case/key_use.h"

namespace tailwater {

namespace {

/// Defaults of [scheme].
std::vector<KeyInfo> defaults(SchemeName name, Formulation formulation,
                              Integrator integrator = Integrator::explicit_projection) {
  SchemeTable scheme{.name = name, .formulation = formulation, .integrator = integrator};
  apply_formulation(scheme);
  return keys_of(scheme);
}

/// The default of `row`, which is number `index` of its table.
std::string default_text(const TableInfo& table, std::size_t index) {
  const KeyInfo& row = table.keys[index];
  if (row.presence == Presence::required) {
    return "required";
  }
  if (row.value == "[]" || row.value == "\"\"") {
    return "";
  }
  if (table.name != "scheme" || row.key == "name" || row.key == "formulation" || row.key == "integrator") {
    return row.value;
  }
  constexpr auto farzin = SchemeName::farzin2014;
  constexpr auto farmani = SchemeName::farmani2020;
  static const auto published_explicit = defaults(farzin, Formulation::published);
  static const auto published_implicit = defaults(farzin, Formulation::published, Integrator::implicit_projection);
  static const auto two_step_robust = defaults(farmani, Formulation::robust);
  static const auto two_step_published = defaults(farmani, Formulation::published);

  /// The values with the first and the second choice, each shown only where it differs from what is known.
  const auto pair = [](const std::string& first, std::string_view second_name, const std::string& second,
                       const std::string& known) {
    std::string text = first == known ? "" : first;
    if (second != first) text += fmt::format("{}{}{}", text.empty() ? "" : ", ", second_name, second);
    return text;
  };
  std::vector<std::string> others;
  const auto add = [&](std::string_view heading, const std::string& text) {
    if (!text.empty()) others.push_back(fmt::format("{}{}", heading, text));
  };
  add("published: ", pair(published_explicit[index].value, "implicit ", published_implicit[index].value, row.value));
  if (key_use_text("scheme", row.key).find("farzin2014") == std::string::npos) {
    add("farmani2020: ", pair(two_step_robust[index].value, "published ", two_step_published[index].value, row.value));
  }
  return others.empty() ? row.value : fmt::format("{} ({})", row.value, fmt::join(others, "; "));
}

std::string type_text(const KeyInfo& row) {
  if (row.type == "vector") {
    return "list of `dimension` numbers";
  }
  if (row.type == "points") {
    return "list of points";
  }
  if (row.type == "numbers") {
    return "list of numbers";
  }
  if (row.type == "texts") {
    return "list of names";
  }
  return row.type;
}

/// A cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '|') {
      escaped += '\\';
    }
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

}  // namespace

std::string case_help() {
  std::string text =
      "A case file is TOML. Numbers are SI, or expressions in quotes such as \"2*H\" of the names in [parameters],\n"
      "of pi, dx (particles.spacing) and g (|physics.gravity|).\n"
      "Functions: " +
      functions_text() + "\n";
  for (const TableInfo& table : case_tables()) {
    text += fmt::format("\n{}  {}\n", table.heading(), table.doc);
    for (std::size_t i = 0; i < table.keys.size(); ++i) {
      const KeyInfo& row = table.keys[i];
      const std::string fallback = default_text(table, i);
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
      "Made by `tailwater run --help-case=markdown > docs/reference/case-file.md`; change `src/case/spec.h`, not this "
      "page.\n\n"
      "A case file is [TOML](https://toml.io). Unknown keys are errors, and all problems of a file are reported at "
      "once.\n\n"
      "## Numbers\n\n"
      "Numbers are SI, without units. Any number, also one in a list, may be written as an "
      "expression in quotes:\n\n"
      "```toml\n[parameters]\nH = 0.6\nL = \"2*H\"\n\n[[fluid]]\nmin = [0, 0]\nmax = [\"L\", \"H\"]\n```\n\n"
      "- operators: `+ - * / ^` and parentheses; `^` binds tighter than the sign, `-2^2` is -4; `a < b ? c : d` is c "
      "or "
      "d\n"
      "- names: the keys of `[parameters]` (letters, digits, `_`; they may use one another in any order), `pi`, `dx` = "
      "`particles.spacing`, `g` = the magnitude of `physics.gravity`; in `fluid.velocity` also `x`, `y`, `z`, the "
      "particle's position, and in what varies with time (such as `wall.displacement` and `inlet.discharge`) the time "
      "`t`; none of these can name a "
      "parameter\n"
      "- functions: " +
      functions_text() +
      "\n\n"
      "`particles.spacing` may use parameters only; `physics.gravity` may use parameters and `dx`.\n\n"
      "## Changes from the command line\n\n"
      "`--set key=value` replaces or adds one value: `--set scheme.integrator=implicit`, `--set parameters.H=0.5`, "
      "`--set 'fluid[0].max=[1, 2]'` (tables count from 0), `--set probe.NAME.interval=0.01`. Words and expressions "
      "need no "
      "quotes.\n\n"
      "## Tables\n\n"
      "`[name]` appears once, `[[name]]` any number of times. *Goes with* names the shapes or types that a key belongs "
      "to; with any other the key is an error.\n\n"
      "`scheme.formulation = \"published\"` changes the defaults marked *published*. It detects the free surface by "
      "an empty cone; `surface = \"farzin\"` selects the paper's own detection (F35). `scheme.name = \"farmani2020\"` "
      "changes those marked *farmani2020*.\n");
  for (const TableInfo& table : case_tables()) {
    text += fmt::format("\n### {}\n\n{}.\n\n", table.heading(), table.doc);
    text += "| key | type | default | unit | range | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
    for (std::size_t i = 0; i < table.keys.size(); ++i) {
      const KeyInfo& row = table.keys[i];
      const std::string use = key_use_text(table.name, row.key);
      text +=
          fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", row.key, type_text(row), default_text(table, i),
                      row.unit, row.allowed, cell(row.doc), use.empty() ? "" : fmt::format(". *Goes with* {}", use));
    }
  }
  return text;
}

}  // namespace tailwater
