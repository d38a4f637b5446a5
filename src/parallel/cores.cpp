#include "parallel/cores.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <set>
#include <string>

namespace tailwater {
namespace {

namespace fs = std::filesystem;

/// Processor time granted to a control group, by the files of version 2 ("200000 100000" is two processors, "max" is no
/// limit) or of version 1 (-1 is no limit).
double granted_to(const fs::path& group) {
  double quota = 0.0, period = 0.0;
  std::ifstream(group / "cpu.max") >> quota >> period;
  if (period == 0.0) {
    std::ifstream(group / "cpu.cfs_quota_us") >> quota;
    std::ifstream(group / "cpu.cfs_period_us") >> period;
  }
  return quota > 0.0 && period > 0.0 ? quota / period : std::numeric_limits<double>::infinity();
}

/// The smallest time granted to the nested groups that contain this process.
double granted_processors(const fs::path& root) {
  double least = std::numeric_limits<double>::infinity();
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // "0::/user.slice", or "4:cpu,cpuacct:/docker/1a2b"
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && ("," + controllers + ",").find(",cpu,") == std::string::npos) continue;
    const fs::path mount = root / "sys/fs/cgroup" / (controllers.empty() ? "" : "cpu");
    fs::path group = fs::path(line.substr(second + 1)).relative_path();
    for (; !group.empty(); group = group.parent_path()) least = std::min(least, granted_to(mount / group));
    least = std::min(least, granted_to(mount));
  }
  return least;
}

}  // namespace

std::vector<int> usable_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return {0};
  for (int p = 0; p < CPU_SETSIZE; ++p) {
    if (CPU_ISSET(p, &set)) processors.push_back(p);
  }
  return processors;
}

int cores_of(const std::vector<int>& processors, const fs::path& root) {
  std::set<std::string> cores;
  for (const int p : processors) {
    std::string threads;
    std::ifstream(root / fmt::format("sys/devices/system/cpu/cpu{}/topology/thread_siblings_list", p)) >> threads;
    cores.insert(threads.empty() ? std::to_string(p) : threads);
  }
  return std::max(1, static_cast<int>(std::min(static_cast<double>(cores.size()), granted_processors(root))));
}

}  // namespace tailwater
