// Migration of case files of earlier formats, for each removed key.
#include "case_help/migration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "case/case_file.h"
#include "case/removed_keys.h"
#include "case/spec.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

const std::string format_line = fmt::format("format = {}\n", case_format);

std::string migrated(const std::string& text) { return migrate_case(text, "old.toml").text; }

/// A value of the key that the reader of its time accepted, and that today's reader accepts for the successor of the
/// key, if there is one.
std::string value_for(const RemovedKey& key) {
  if (key.key == "shifting") return "\"none\"";
  if (key.key == "divergence_free") return "\"start\"";
  if (key.key == "displacement") return "\"mean-velocity\"";
  return key.key == "support" ? "3.5" : "0.125";
}

/// One row for each entry of the list of removed keys, hence for each change of the format.
class RemovedKeyTest : public testing::TestWithParam<RemovedKey> {};

TEST_P(RemovedKeyTest, BecomesWhatIsReadToday) {
  const RemovedKey& key = GetParam();
  const std::string line = fmt::format("{} = {}  # why\n", key.key, value_for(key));
  const std::string old_case = fmt::format("{}[{}]\n{}{}", required_keys, key.table, line, water);
  EXPECT_NE(message_of(old_case).find("tailwater migrate"), std::string::npos);
  const Migration migration = migrate_case(old_case, "old.toml");
  ASSERT_EQ(migration.changes.size(), 2u);
  EXPECT_TRUE(migration.changes[0].starts_with("old.toml:1: case.format")) << migration.changes[0];
  EXPECT_TRUE(migration.changes[1].starts_with(fmt::format("old.toml:4: {}.{} ", key.table, key.key)));
  const CaseSpec spec = read_text(migration.text);
  if (key.successor.empty()) {
    EXPECT_NE(migration.text.find("# removed: " + line), std::string::npos) << migration.text;
    EXPECT_EQ(spec.study, StudyTable{});
  } else {
    const std::string value = key.key == "shifting" ? "0" : value_for(key);
    EXPECT_NE(migration.text.find(fmt::format("[study]\n{} = {}  # why\n", key.successor, value)), std::string::npos)
        << migration.text;
    EXPECT_NE(spec.study, StudyTable{});
  }
}

INSTANTIATE_TEST_SUITE_P(Case, RemovedKeyTest, testing::ValuesIn(removed_keys().begin(), removed_keys().end()),
                         [](const auto& key) { return fmt::format("{}_{}", key.param.table, key.param.key); });

/// An outlet that was a hole must now give the condition beyond it; the file alone does not show whether an outlet is a
/// hole.
TEST(Migration, ReportsOutletsWithoutALevel) {
  const std::string ends =
      "[[outlet]]\nfrom = [1, 0]\nto = [1, 1]\n[[outlet]]\nfrom = [0, 0]\nto = [0, 1]\nlevel = 1\nabsorbing = 0\n";
  const Migration migration = migrate_case(required_keys + water + ends, "old.toml");
  ASSERT_EQ(migration.changes.size(), 2u);
  EXPECT_NE(migration.changes[1].find("outlet[0] is a channel that continues"), std::string::npos);
  EXPECT_NE(migration.changes[1].find("beyond = \"air\""), std::string::npos);
  EXPECT_EQ(migrate_case(migration.text, "new.toml").changes.size(), 0u);
}

/// Levels were held on average; the file does not show whether waves must leave.
TEST(Migration, ReportsLevelsThatAreHeldNow) {
  const std::string ends = "[[inlet]]\nlevel = 1\n[[outlet]]\nlevel = 1\nabsorbing = 1\n[[outlet]]\nlevel = 1\n";
  const Migration migration = migrate_case(required_keys + water + ends, "old.toml");
  ASSERT_EQ(migration.changes.size(), 3u);
  EXPECT_NE(migration.changes[1].find("inlet[0] holds its level"), std::string::npos);
  EXPECT_NE(migration.changes[2].find("outlet[1] holds its level"), std::string::npos);
}

TEST(Migration, LeavesACaseOfThisFormatAsItIs) {
  const std::string text = required_keys + "case.format = 1 # ours\n" + water;
  const Migration migration = migrate_case(text, "case.toml");
  EXPECT_EQ(migration.text, text);
  EXPECT_TRUE(migration.changes.empty());
}

TEST(Migration, WritesTheFormatIntoTheTableOfTheCase) {
  EXPECT_EQ(migrated("# head\n[case]  # general\ntitle = \"a\"\n"),
            "# head\n[case]  # general\n" + format_line + "title = \"a\"\n");
  EXPECT_EQ(migrated("case.title = \"a\""), "case." + format_line + "case.title = \"a\"\n");
}

TEST(Migration, KeepsAByteOrderMarkAndTheEndsOfLines) {
  const std::string mark = "\xef\xbb\xbf";
  const std::string keys =
      "[particles]\nspacing = 0.1\n[time]\nend = 1.0\n[scheme]\nshifting = \"none\"  # why\n" + water;
  const std::string old_case = "[case]\ntitle = \"x\"\n" + keys;
  const auto with_cr = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
    return text;
  };
  const std::string expected = migrated(old_case);
  EXPECT_TRUE(expected.starts_with("[case]\n" + format_line)) << expected;
  EXPECT_NE(expected.find("[study]\nshifting = 0  # why\n"), std::string::npos) << expected;
  EXPECT_EQ(migrated(mark + old_case), mark + expected);
  EXPECT_EQ(migrated(with_cr(old_case)), with_cr(expected));
  EXPECT_EQ(migrated(mark + with_cr(old_case)), mark + with_cr(expected));
  EXPECT_TRUE(migrated(mark + keys).starts_with(mark + "case." + format_line));
}

TEST(Migration, KeepsCommentsAndWhatItDoesNotKnow) {
  EXPECT_EQ(migrated("[case]\n[scheme]\n# numerics\nsupport = 4 # wide\nkernel = \"farzin\"\ncourant = 0.3\n\n# "
                     "end\n[other]\nkey = [1,\n2]\n"),
            "[case]\n" + format_line +
                "[scheme]\n# numerics\n# removed: kernel = \"farzin\"\ncourant = 0.3\n\n# end\n[other]\nkey = [1,\n2]\n"
                "\n[study]\nsupport = 4 # wide\n");
}

TEST(Migration, AddsToTheStudiesThatAreThere) {
  EXPECT_EQ(migrated("case.format = 1\n[study]\nlength = 1\n[scheme]\nsupport = 4\n"),
            "case.format = 1\n[study]\nsupport = 4\nlength = 1\n[scheme]\n");
}

TEST(Migration, TellsShiftingByItsKindAndStrength) {
  const std::string head = "case.format = 1\n[scheme]\n";
  EXPECT_EQ(migrated(head + "shifting_strength = 2\nshifting = \"lind\"\n"),
            head + "# removed: shifting = \"lind\"\n\n[study]\nshifting = 2\n");
  EXPECT_EQ(migrated(head + "shifting_strength = 2\nshifting = \"none\"\n"),
            head + "# removed: shifting_strength = 2\n\n[study]\nshifting = 0\n");
}

TEST(Migration, KnowsThatPublishedSchemesHaveNoStudies) {
  const std::string head = "case.format = 1\n[scheme]\nformulation = \"published\"\n";
  EXPECT_EQ(migrated(head + "support = 4\n"), head + "# removed: support = 4\n");
}

TEST(Migration, RefusesWhatItCannotChange) {
  const auto message = [](const std::string& text) {
    return message_of<InputError>([&] { migrate_case(text, "old.toml"); });
  };
  EXPECT_NE(message("case.format = 2\n").find("use a newer version"), std::string::npos);
  EXPECT_NE(message("a = 1\nscheme = { kernel = 3 }\n").find("old.toml:2: scheme.kernel stands in braces"),
            std::string::npos);
  EXPECT_NE(message("[case\n").find("old.toml:1"), std::string::npos);
}

}  // namespace
}  // namespace tailwater
