#include "io/run_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/temporary_folder.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// Everything below `folder`, sorted.
std::vector<std::string> tree(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(RunFolder, IsMadeWithItsParents) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path() / "a" / "b", false);
  EXPECT_EQ(run.path(), folder.path() / "a" / "b");
  EXPECT_EQ(tree(run.path()), (Names{".lock", "fields", "probes"}));
  EXPECT_EQ(run.probe("wall"), run.path() / "probes" / "wall.csv");
}

TEST(RunFolder, AnEmptyFolderIsTakenAsItIs) {
  const TemporaryFolder folder;
  RunFolder::create(folder.path(), false);
  EXPECT_EQ(tree(folder.path()), (Names{"fields", "probes"}));
}

TEST(RunFolder, IsNeverOverwrittenUnasked) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "summary.json", "{}");
  const std::string message = message_of<InputError>([&] { RunFolder::create(folder.path(), false); });
  EXPECT_NE(message.find(folder.path().string()), std::string::npos) << message;
  EXPECT_NE(message.find("--force"), std::string::npos) << message;
  EXPECT_EQ(tree(folder.path()), (Names{"summary.json"}));
}

TEST(RunFolder, IsLockedWhileItsRunGoes) {
  const TemporaryFolder folder;
  {
    const RunFolder run = RunFolder::create(folder.path(), false);
    write_text_file(run.steps(), "result");
    for (const bool force : {false, true}) {
      const std::string message = message_of<InputError>([&] { RunFolder::create(folder.path(), force); });
      EXPECT_NE(message.find("still going (process "), std::string::npos) << message;
    }
    EXPECT_EQ(text_of(run.steps()), "result");
  }
  EXPECT_EQ(tree(folder.path()), (Names{"fields", "probes", "steps.csv"}));
  EXPECT_NO_THROW(RunFolder::create(folder.path(), true));
}

TEST(RunFolder, TheLockOfAKilledRunLocksNothing) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / ".lock", "process 1 on a machine");
  EXPECT_NO_THROW(RunFolder::create(folder.path(), false));
}

TEST(RunFolder, ForceRemovesWhatARunWroteAndNothingElse) {
  const TemporaryFolder folder;
  {
    const RunFolder run = RunFolder::create(folder.path(), false);
    fs::create_directory(run.checkpoints());
    for (const fs::path& path :
         {run.steps(), run.ranks(), run.summary(), run.stop(), run.checkpoint_request(), run.log(), run.checkpoint(5),
          run.checkpoints() / "step_000000000010.h5.part", run.probe("wall"), run.fields() / "fields.pvd",
          run.fields() / "fields_00000.vtp", run.fields() / "fields_00001.vtp.part", run.fields() / "walls_123456.vtp",
          run.make_failure() / "last_good.vtp"}) {
      write_text_file(path, "result");
    }
    write_text_file(run.effective_case(), "[[wall]]\nname = \"other\"\n[[probe]]\nname = \"wall\"  # a \"name\"\n");
  }
  for (const char* name :
       {"notes.txt", "case.toml", "fields/view.pvsm", "fields/fields_a.vtp", "fields/fields_01.vtp", "fields/mine.vtp",
        "probes/plot.py", "probes/laboratory.csv", "probes/other.csv", "failure/why.txt", "checkpoints/copy.h5"}) {
    write_text_file(folder.path() / name, "foreign");
  }
  fs::create_directory(folder.path() / "fields" / "fields_00002.vtp");
  RunFolder::create(folder.path(), true);
  // The case stays until the new run replaces it.
  EXPECT_EQ(tree(folder.path()),
            (Names{"case.effective.toml", "case.toml", "checkpoints", "checkpoints/copy.h5", "failure",
                   "failure/why.txt", "fields", "fields/fields_00002.vtp", "fields/fields_01.vtp",
                   "fields/fields_a.vtp", "fields/mine.vtp", "fields/view.pvsm", "notes.txt", "probes",
                   "probes/laboratory.csv", "probes/other.csv", "probes/plot.py"}));
}

TEST(RunFolder, ForceDoesNotFollowLinks) {
  const TemporaryFolder elsewhere;
  write_text_file(elsewhere.path() / "measured.csv", "foreign");
  const TemporaryFolder folder;
  fs::create_directory_symlink(elsewhere.path(), folder.path() / "probes");
  fs::create_symlink(elsewhere.path() / "measured.csv", folder.path() / "steps.csv");
  const auto refused = [&] { return message_of<InputError>([&] { RunFolder::create(folder.path(), true); }); };
  EXPECT_NE(refused().find("steps.csv' is a link"), std::string::npos);
  fs::remove(folder.path() / "steps.csv");
  EXPECT_NE(refused().find("probes' is a link"), std::string::npos);
  EXPECT_THROW(RunFolder::open(folder.path()), InputError);
  EXPECT_EQ(text_of(elsewhere.path() / "measured.csv"), "foreign");
  EXPECT_EQ(tree(elsewhere.path()), (Names{"measured.csv"}));
}

TEST(RunFolder, AFileInItsPlaceIsBadInput) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "out", "foreign");
  for (const bool force : {false, true}) {
    EXPECT_THROW(RunFolder::create(folder.path() / "out", force), InputError);
  }
  EXPECT_EQ(text_of(folder.path() / "out"), "foreign");
}

TEST(RunFolder, UnwritableIsAnIoErrorForRootToo) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "file", "foreign");
  const auto below_a_file = folder.path() / "file" / "out";
  const std::string message = message_of<IoError>([&] { RunFolder::create(below_a_file, false); });
  EXPECT_NE(message.find(below_a_file.string()), std::string::npos) << message;
  EXPECT_EQ(tree(folder.path()), (Names{"file"}));
  // A file system on which no user can make a folder.
  EXPECT_THROW(RunFolder::create("/proc/tailwater", false), IoError);
}

TEST(RunFolder, NothingIsRemovedWhenItsFoldersCannotBeMade) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "summary.json", "result");
  write_text_file(folder.path() / "fields", "a file where a folder must be");
  EXPECT_THROW(RunFolder::create(folder.path(), true), IoError);
  EXPECT_TRUE(fs::exists(folder.path() / "summary.json"));
}

}  // namespace
}  // namespace tailwater
