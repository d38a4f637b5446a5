#include "run/requests.h"

#include <gtest/gtest.h>

#include <thread>

#include "io/temporary_folder.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// Waits for the look at the file that comes next; they are rare.
bool stop_is_asked_soon(Requests& requests) {
  for (int looks = 0; looks < 10000; ++looks) {
    if (requests.stop_is_asked()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(Requests, AFileAsksOnce) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  Requests requests(run, {});
  EXPECT_FALSE(requests.stop_is_asked());
  write_text_file(run.stop(), "");
  EXPECT_TRUE(stop_is_asked_soon(requests));
  EXPECT_FALSE(fs::exists(run.stop()));
}

TEST(Requests, AnySignalAsks) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) {
    Requests requests(run, {});
    EXPECT_FALSE(requests.stop_is_asked());
    std::raise(signal);
    EXPECT_TRUE(requests.stop_is_asked());
  }
}

TEST(StopSender, AsksOnlyARunThatHasBegunSince) {
  const TemporaryFolder folder;
  RunFolder run = RunFolder::create(folder.path() / "run", false);
  for (int start = 0; start < 2; ++start) {  // the second time over the results of the first
    StopSender sender(run.path());
    EXPECT_FALSE(sender.send());
    EXPECT_FALSE(fs::exists(run.stop()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // file systems know times to some milliseconds
    write_text_file(run.effective_case(), "");
    EXPECT_TRUE(sender.send());
    EXPECT_TRUE(fs::exists(run.stop()));
  }
  EXPECT_FALSE(fs::exists(run.stop()));  // nobody has obeyed
}

TEST(StopSender, SaysWhenItCannotAsk) {
  const TemporaryFolder folder;
  StopSender sender(folder.path() / "run");
  EXPECT_FALSE(sender.send());
}

}  // namespace
}  // namespace tailwater
