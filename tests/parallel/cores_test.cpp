#include "parallel/cores.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>

#include "io/temporary_folder.h"

namespace tailwater {
namespace {

/// A folder with the files by which a system describes its processors.
class System {
 public:
  void tell(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    std::ofstream(folder_.path() / file) << text << '\n';
  }
  void tell_threads(int processor, const std::string& of_its_core) {
    tell("sys/devices/system/cpu/cpu" + std::to_string(processor) + "/topology/thread_siblings_list", of_its_core);
  }
  int cores(const std::vector<int>& processors) const { return cores_of(processors, folder_.path()); }

 private:
  TemporaryFolder folder_;
};

TEST(Cores, ThreadsOfACoreCountOnce) {
  System system;
  system.tell_threads(0, "0,2");
  system.tell_threads(1, "1,3");
  system.tell_threads(2, "0,2");
  system.tell_threads(3, "1,3");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 2);
  EXPECT_EQ(system.cores({0, 2}), 1);
  EXPECT_EQ(system.cores({0, 3}), 2);
}

TEST(Cores, ProcessorsOfWhichNothingIsToldAreCores) { EXPECT_EQ(System().cores({0, 1, 7}), 3); }

TEST(Cores, AreThoseThatTheControlGroupIsGranted) {
  System system;
  system.tell("proc/self/cgroup", "0::/all.slice/mine.scope");
  system.tell("sys/fs/cgroup/all.slice/mine.scope/cpu.max", "max 100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 4);
  system.tell("sys/fs/cgroup/all.slice/cpu.max", "250000 100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 2);
  system.tell("sys/fs/cgroup/all.slice/mine.scope/cpu.max", "50000 100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 1);
}

TEST(Cores, AreThoseThatAContainerIsGranted) {
  System system;
  system.tell("proc/self/cgroup", "0::/");
  system.tell("sys/fs/cgroup/cpu.max", "300000 100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 3);
}

TEST(Cores, AreThoseThatAControlGroupOfVersion1IsGranted) {
  System system;
  system.tell("proc/self/cgroup", "9:memory:/docker/1a2b\n4:cpu,cpuacct:/docker/1a2b");
  system.tell("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1");
  system.tell("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 4);
  system.tell("sys/fs/cgroup/cpu/docker/1a2b/cpu.cfs_quota_us", "200000");
  system.tell("sys/fs/cgroup/cpu/docker/1a2b/cpu.cfs_period_us", "100000");
  EXPECT_EQ(system.cores({0, 1, 2, 3}), 2);
}

TEST(Cores, ProcessorsAreThoseOnWhichThisProcessMayRun) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  const std::vector<int> all = usable_processors();
  EXPECT_EQ(static_cast<int>(all.size()), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(all.back(), &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(usable_processors(), std::vector<int>{all.back()});
  sched_setaffinity(0, sizeof(before), &before);
}

}  // namespace
}  // namespace tailwater
