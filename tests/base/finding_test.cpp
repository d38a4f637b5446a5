#include "base/finding.h"

#include <gtest/gtest.h>

namespace tailwater {
namespace {

const CaseLabel bed("wall", "bed");

TEST(CaseLabel, UsesTheNameOrElseTheNumber) {
  EXPECT_EQ(bed.text(), "wall 'bed'");
  EXPECT_EQ(bed.with_key("points").text(), "wall 'bed': points");
  EXPECT_EQ(CaseLabel("wall", 2).with_key("points").text(), "wall[2].points");
  EXPECT_EQ(CaseLabel("particles").with_key("spacing").text(), "particles.spacing");
}

TEST(Finding, TakesItsDataFromTheArgumentsOfTheProblem) {
  const MarkedPlace first{{0.5, 1e-13, 0.0}, 2};
  const Clause second{"{}", MarkedPlace{{1.0, 2.0, 0.0}, 2}};
  const Finding finding = Finding::error("bed-too-thin",
                                         {"{} is {:.2g} too thin at {} and {}, beside {}", bed.with_key("points"),
                                          Amount{0.0123, "m"}, first, second, CaseLabel("fluid", "pond")},
                                         {"make it at least {} m thick", 0.5});
  EXPECT_EQ(finding.message(),
            "wall 'bed': points is 0.012 m too thin at (0.5, 0) and (1, 2), beside fluid 'pond'; make it at least 0.5 "
            "m thick");
  EXPECT_EQ(finding.about.table, "wall");
  EXPECT_EQ(finding.about.name, "bed");
  EXPECT_EQ(finding.about.key, "points");
  ASSERT_EQ(finding.places.size(), 2u);
  EXPECT_EQ(finding.places[0].x, first.x) << "not as it is shown";
  EXPECT_EQ(finding.value->number, 0.0123);
  EXPECT_EQ(finding.value->unit, "m");
  EXPECT_EQ(finding.remedy, "make it at least 0.5 m thick");
}

TEST(Finding, BeginsWithItsPositionAndEndsWithItsId) {
  Finding finding = Finding::warning("bed-dry", {"the bed is dry"}, {});
  EXPECT_EQ(finding.line(), "the bed is dry [bed-dry]");
  finding.position = {"case.toml", 3};
  EXPECT_EQ(finding.line(), "case.toml:3: the bed is dry [bed-dry]");
  finding.position.column = 7;
  EXPECT_EQ(finding.line(), "case.toml:3:7: the bed is dry [bed-dry]");
}

TEST(CaseError, ShowsTheFirstFiftyFindings) {
  const CaseError error(Findings(52, Finding::error("bed-dry", {"the bed is dry"}, {"add water"})));
  const std::string text = error.what();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 49);
  EXPECT_TRUE(text.ends_with("the bed is dry; add water [bed-dry] (and 2 more problems)"));
  EXPECT_EQ(error.findings().size(), 52u);
}

TEST(MergeAlike, NamesAllTablesThatHaveTheSameFinding) {
  const auto hose = [](const std::string& name, double x, double depth) {
    return Finding::warning(
        "bed-wet",
        {"{} is {:.2g} deep at {}", CaseLabel("inlet", name), Amount{depth, "m"}, MarkedPlace{{x, 0.0, 0.0}, 2}},
        {"use a smaller spacing"});
  };
  const Findings merged =
      merge_alike({hose("a", 1.0, 0.1), hose("b", 2.0, 0.1), hose("c", 3.0, 0.2), hose("d", 4.0, 0.1)});
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].message(),
            "inlet 'a' is 0.1 m deep at (1, 0) (likewise inlet 'b', inlet 'd'); use a smaller spacing");
  EXPECT_EQ(merged[0].places.size(), 3u);
  EXPECT_EQ(merged[1].message(), hose("c", 3.0, 0.2).message());
}

}  // namespace
}  // namespace tailwater
