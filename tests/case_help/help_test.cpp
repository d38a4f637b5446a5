#include "case_help/help.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "case/key_info.h"
#include "case/key_use.h"

namespace tailwater {
namespace {

TEST(CaseReference, InTheTreeIsWhatTheProgramWrites) {
  std::ifstream file(TAILWATER_SOURCE_DIR "/docs/reference/case-file.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_TRUE(page.str() == case_reference_markdown())
      << "docs/reference/case-file.md is out of date; run: tailwater run --help-case=markdown > "
         "docs/reference/case-file.md";
}

TEST(StudyReference, InTheTreeIsWhatTheProgramWrites) {
  std::ifstream file(TAILWATER_SOURCE_DIR "/docs/reference/study-keys.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_TRUE(page.str() == study_reference_markdown())
      << "docs/reference/study-keys.md is out of date; run: tailwater run --help-case=study > "
         "docs/reference/study-keys.md";
}

TEST(ProbeReference, InTheTreeIsWhatTheProgramWrites) {
  std::ifstream file(TAILWATER_SOURCE_DIR "/docs/reference/probes.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_TRUE(page.str() == probe_reference_markdown())
      << "docs/reference/probes.md is out of date; run: tailwater run --help-case=probes > docs/reference/probes.md";
}

/// Bounds that the tree has set itself: a user meets all of these keys.
TEST(CaseReference, HasNoMoreKeysThanItMay) {
  std::size_t all = 0;
  for (const TableInfo& table : case_tables()) {
    const auto keys = static_cast<std::size_t>(
        std::ranges::count_if(table.keys, [](const KeyInfo& key) { return key.presence != Presence::written; }));
    if (table.name == "study") {
      EXPECT_LE(keys, 10u);
    }
    if (table.name == "scheme") {
      EXPECT_LE(keys, 9u);
    }
    // On the page of keys for studies, which no case needs.
    if (table.name == "study" || table.name == "parallel" || table.name == "limits") continue;
    all += keys;
  }
  EXPECT_LE(all, 222u);
}

TEST(CaseHelp, TellsEveryKeyOfEveryTable) {
  const std::string help = case_help();
  for (const TableInfo& table : case_tables()) {
    const std::size_t start = help.find(fmt::format("\n{}  ", table.heading()));
    ASSERT_NE(start, std::string::npos) << table.heading();
    for (const KeyInfo& key : table.keys) {
      if (key.presence == Presence::written) continue;
      const std::size_t place = help.find(fmt::format("\n  {} (", key.key), start);
      ASSERT_NE(place, std::string::npos) << table.heading() << ' ' << key.key;
      EXPECT_NE(help.find(key.doc, place), std::string::npos) << key.key;
    }
  }
}

TEST(CaseHelp, TellsRequirementsDefaultsUnitsAndRanges) {
  const std::string help = case_help();
  for (const char* line :
       {"  spacing (number, m, required)\n",
        "  courant (number, default 0.55 (published: 0.05, implicit 0.12; farmani2020: 0.25, published 0.1))\n",
        "      allowed: above 0\n", "      goes with shape = \"box\" (needed)\n"}) {
    EXPECT_NE(help.find(line), std::string::npos) << line;
  }
}

TEST(RangeText, SaysTheBounds) {
  EXPECT_EQ(range_text(Range::any()), "");
  EXPECT_EQ(range_text(Range::above(0.0)), "above 0");
  EXPECT_EQ(range_text(Range::at_least(1.0)), "at least 1");
  EXPECT_EQ(range_text(Range::between(2.0, 5.0)), "2 to 5");
  EXPECT_EQ(range_text(Range::above_up_to(0.0, 1.0)), "above 0, at most 1");
}

/// Every choice of a selector has its row, once, and the rows name keys that exist.
TEST(KeyUses, FitTheTables) {
  for (const KeyUse& use : key_uses()) {
    for (const TableInfo& table : case_tables()) {
      if (table.name != use.table) {
        continue;
      }
      const auto has_key = [&](std::string_view key) {
        return std::any_of(table.keys.begin(), table.keys.end(), [&](const KeyInfo& row) { return row.key == key; });
      };
      EXPECT_TRUE(has_key(use.selector)) << use.table << ' ' << use.selector;
      for (const std::string_view key : use.needed) {
        EXPECT_TRUE(has_key(key)) << use.table << ' ' << key;
      }
      for (const std::string_view key : use.possible) {
        EXPECT_TRUE(has_key(key)) << use.table << ' ' << key;
      }
    }
  }
  const auto expect_rows = [](std::string_view table, std::string_view selector, auto names) {
    for (const std::string_view name : names) {
      const auto uses = key_uses();
      const auto rows = std::count_if(uses.begin(), uses.end(), [&](const KeyUse& use) {
        return use.table == table && use.selector == selector && use.choice == name;
      });
      EXPECT_EQ(rows, 1) << table << ' ' << selector << ' ' << name;
    }
  };
  expect_rows("fluid", "shape", choices<BlockShape>);
  expect_rows("wall", "shape", choices<WallShape>);
  expect_rows("wall", "slip", choices<Slip>);
  expect_rows("probe", "type", choices<ProbeType>);
}

}  // namespace
}  // namespace tailwater
