// The table of a sweep: what its members have come to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sweep_plan.h"

namespace tailwater {

inline constexpr std::string_view sweep_table_name = "sweep.csv";

/// What is known of a member apart from its folder.
struct MemberNews {
  bool is_running = false;
  std::optional<int> exit_code;  ///< with which its last process ended, if that was in this sweep
  std::string message;           ///< of that process
};

/// How a member is: "waiting", "running", "done", "interrupted", "failed" or "killed".
std::string member_status(const std::filesystem::path& member, const MemberNews& news = {});

/// A line for each member: folder, values of the keys, status, and what its summary says about cost and errors; empty
/// where there is nothing to say. CSV with a line of names.
std::string sweep_table(const std::filesystem::path& sweep, const SweepPlan& plan, const std::vector<MemberNews>& news);

/// The same in short, for a reader.
std::string sweep_digest(const std::filesystem::path& sweep, const SweepPlan& plan);

}  // namespace tailwater
