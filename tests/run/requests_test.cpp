#include "run/requests.h"

#include <gtest/gtest.h>

#include <thread>

#include "io/temporary_folder.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// Repeats the look at the files until it finds a request; the files are looked at only rarely.
Asked asked_soon(Requests& requests) {
  for (int looks = 0; looks < 10000; ++looks) {
    const Asked asked = requests.look();
    if (asked.stop || asked.checkpoint) return asked;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return {};
}

TEST(Requests, AFileAsksOnce) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  Requests requests(run, {});
  EXPECT_FALSE(requests.look().stop);
  write_text_file(run.stop(), "");
  EXPECT_TRUE(asked_soon(requests).stop);
  EXPECT_FALSE(fs::exists(run.stop()));
}

TEST(Requests, AFileAsksForACheckpointUntilThereIsOne) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  Requests requests(run, {});
  write_text_file(run.checkpoint_request(), "");
  EXPECT_TRUE(asked_soon(requests).checkpoint);
  EXPECT_TRUE(requests.look().checkpoint);
  EXPECT_FALSE(requests.look().stop);
  EXPECT_TRUE(fs::exists(run.checkpoint_request()));
  requests.fulfil_checkpoint();
  EXPECT_FALSE(fs::exists(run.checkpoint_request()));
  EXPECT_FALSE(requests.look().checkpoint);
}

TEST(Requests, TheLossOfTheTerminalAsksForACheckpoint) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  Requests requests(run, {});
  for (int loss = 0; loss < 2; ++loss) {
    EXPECT_FALSE(requests.look().checkpoint);
    std::raise(SIGHUP);
    EXPECT_TRUE(requests.look().checkpoint);
    EXPECT_FALSE(requests.look().stop);
    requests.fulfil_checkpoint();
  }
}

TEST(Requests, TheWallTimeAsksBeforeItIsUp) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  const auto now = std::chrono::steady_clock::now();
  Requests early(run, {}, {now, std::chrono::hours(1)});
  EXPECT_FALSE(early.look().stop);
  // 36 s of an hour are reserved.
  Requests late(run, {}, {now - std::chrono::minutes(59) - std::chrono::seconds(30), std::chrono::hours(1)});
  EXPECT_TRUE(late.look().stop);
}

TEST(Requests, AnySignalAsks) {
  const TemporaryFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), false);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) {
    Requests requests(run, {});
    EXPECT_FALSE(requests.look().stop);
    std::raise(signal);
    EXPECT_TRUE(requests.look().stop);
  }
}

TEST(RequestSender, AsksOnlyARunThatHasBegunSince) {
  const TemporaryFolder folder;
  RunFolder run = RunFolder::create(folder.path() / "run", false);
  for (int start = 0; start < 2; ++start) {  // the second time over the results of the first
    RequestSender sender(run.path());
    EXPECT_FALSE(sender.ask_for_stop());
    EXPECT_FALSE(fs::exists(run.stop()));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // file systems store times to some milliseconds
    write_text_file(run.summary(), "");
    EXPECT_TRUE(sender.ask_for_stop());
    EXPECT_TRUE(fs::exists(run.stop()));
  }
  EXPECT_FALSE(fs::exists(run.stop()));  // no run has answered the request
}

TEST(RequestSender, SaysWhenItCannotAsk) {
  const TemporaryFolder folder;
  RequestSender sender(folder.path() / "run");
  EXPECT_FALSE(sender.ask_for_stop());
}

}  // namespace
}  // namespace tailwater
