#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "case/probe_columns.h"
#include "case_help/help.h"

namespace tailwater {
namespace {

/// A cell with the difference between 2D and 3D.
std::string by_dimension(const std::string& in_2d, const std::string& in_3d) {
  if (in_2d == in_3d) return in_2d;
  if (in_2d.empty()) return "3D: " + in_3d;
  if (in_3d.empty()) return "2D: " + in_2d;
  if (in_3d.starts_with(in_2d + ", ")) return in_2d + ", in 3D also " + in_3d.substr(in_2d.size() + 2);
  return fmt::format("2D: {}; 3D: {}", in_2d, in_3d);
}

std::string headings_cell(const DeclaredColumn& column) {
  const auto in = [&](int dimension) {
    std::vector<std::string> headings;
    for (const OutputColumn& one : columns_in(dimension, column)) headings.push_back(fmt::format("`{}`", one.heading));
    return fmt::format("{}", fmt::join(headings, ", "));
  };
  return by_dimension(in(2), in(3));
}

std::string unit_cell(Measure measure) {
  return by_dimension(std::string(unit_of(measure, 2)), std::string(unit_of(measure, 3)));
}

std::string comparison_cell(const DeclaredColumn& column, ProbeType type) {
  if (column.comparison == Comparison::none) return "";
  const std::string text = column.comparison == Comparison::by_default ? "default" : "yes";
  ProbeTable probe;
  probe.type = type;
  return by_dimension(text, comparable_columns(probe, 3).empty() ? "" : text);
}

// In the order of Statistic.
constexpr std::array<std::string_view, 12> statistics{"average over the second half of the run",
                                                      "maximum",
                                                      "maximum magnitude of the vector",
                                                      "largest moving average; absent if longer than half of the run",
                                                      "last reading",
                                                      "minimum and maximum",
                                                      "rate of change, averaged over the second half of the run",
                                                      "largest mean rate of change over `averaging_time`",
                                                      "largest mean over `averaging_time`",
                                                      "time in which that mean rises from a tenth to its largest value",
                                                      "minimum of the last profile",
                                                      "maximum of the last profile"};

/// Empty where the result does not exist.
std::string unit_of_result(const DeclaredResult& result, const ProbeInfo& info, int dimension) {
  for (const DeclaredColumn& declared : info.columns) {
    for (const OutputColumn& column : columns_in(dimension, declared)) {
      if (column.name != result.column) continue;
      return std::string(unit_of(measure_of(result.statistic, column.measure), dimension));
    }
  }
  return "";
}

std::string section_of(const ProbeInfo& info) {
  std::string text =
      fmt::format("\n## {}\n\n{}.\n\n| column | unit | meaning | measurement |\n| --- | --- | --- | --- |\n",
                  name_of(info.type), info.doc);
  for (const DeclaredColumn& column : info.columns) {
    text += fmt::format("| {} | {} | {} | {} |\n", headings_cell(column), unit_cell(column.measure), column.doc,
                        comparison_cell(column, info.type));
  }
  text += "\n| result | of column | unit | statistic |\n| --- | --- | --- | --- |\n";
  for (const DeclaredResult& result : info.results) {
    const std::string unit = by_dimension(unit_of_result(result, info, 2), unit_of_result(result, info, 3));
    text += fmt::format("| {} | `{}` | {} | {} |\n", result.name, result.column, unit,
                        statistics[static_cast<std::size_t>(result.statistic)]);
  }
  if (info.totals.empty()) return text;
  text += "\n| total | unit | meaning |\n| --- | --- | --- |\n";
  for (const DeclaredColumn& total : info.totals) {
    text += fmt::format("| {} | {} | {} |\n", headings_cell(total), unit_cell(total.measure), total.doc);
  }
  return text;
}

}  // namespace

std::string probe_reference_markdown() {
  std::string text =
      "# Output of probes\n\n"
      "For users who read the results of probes. [theory/probes.md](../theory/probes.md) defines the numbers,\n"
      "[case-file.md](case-file.md#probe) lists the keys of a probe, and [examples.md](examples.md#types-of-probes) "
      "shows each\ntype in a case. Units are SI. In 2D forces, volumes and energies are per metre of width.\n\n"
      "Each section has up to three tables:\n\n"
      "- *Columns* are those of `probes/NAME.csv`, after `time_s`. The cell *measurement* shows whether a "
      "`[[measurement]]` can\n  name the column, without its unit, as in `force_x`. A measurement without `column` is "
      "compared with the default. If\n  the default has several columns, it is the first of them.\n"
      "- *Results* are printed at the end of a run and by `tailwater info`. They are in `summary.json`, in `results`.\n"
      "- *Totals* are numbers of the whole run. They are in `summary.json`, in `probes`.\n\n"
      "A mean is marked *still rising* if the averages over the four quarters of the second half increase from quarter "
      "to\nquarter, by more than 1 % in all. It is marked *still falling* if they decrease in this way. A longer run "
      "then gives\nanother mean.\n\n"
      "A mean of fewer than five readings in the second half is marked with their number. A result without the "
      "readings "
      "that\nit takes is left out: a mean without a reading in the second half, a rate of change without two, a "
      "largest "
      "mean of a\nprobe that read once.\n\n"
      "Compare largest pressures at first contacts over the same `averaging_time`. Its default depends on dx if dx is "
      "coarser\nthan H/30.\n\n"
      "`tailwater run --help-case=probes > docs/reference/probes.md` writes this page. Change\n"
      "`src/case/probe_types.cpp` instead.\n";
  for (std::size_t k = 0; k < choices<ProbeType>.size(); ++k) text += section_of(info_of(static_cast<ProbeType>(k)));
  return text;
}

}  // namespace tailwater
