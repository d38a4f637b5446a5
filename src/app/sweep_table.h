// The table of a sweep: the results of its members.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sweep_plan.h"

namespace tailwater {

inline constexpr std::string_view sweep_table_name = "sweep.csv";

/// The state of a member that its folder does not contain.
struct MemberNews {
  bool is_running = false;
  std::optional<int> exit_code;  ///< of its last process, if that was in this sweep
  std::string message;           ///< message of that process
};

/// The status of a member: "waiting", "running", "done", "interrupted", "failed" or "killed".
std::string member_status(const std::filesystem::path& member, const MemberNews& news = {});

/// A line for each member: folder, values of the keys, status, and the cost and errors from its summary; empty fields
/// where these are unknown. CSV with a line of names.
std::string sweep_table(const std::filesystem::path& sweep, const SweepPlan& plan, const std::vector<MemberNews>& news);

/// A short version of the table, for a reader.
std::string sweep_digest(const std::filesystem::path& sweep, const SweepPlan& plan);

}  // namespace tailwater
