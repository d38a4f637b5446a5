// The plan of a sweep: one member for each value of a key of the case, or for each set of values of several keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case/spec.h"

namespace tailwater {

struct SweepKey {
  std::string key;
  std::vector<std::string> values;
};

struct SweepMember {
  std::string folder;               ///< name in the folder of the sweep, made from the values
  std::vector<std::string> values;  ///< values of the keys, in their order

  bool operator==(const SweepMember&) const = default;
};

struct SweepPlan {
  std::vector<std::string> keys;
  std::vector<SweepMember> members;
};

/// The plan of `--sweep` options such as "particles.spacing=0.02,0.01": the product of all keys, the last one varying
/// fastest. Commas inside brackets and quotes belong to a value. Throws InputError, which names the option.
SweepPlan sweep_plan(const std::vector<std::string>& options);

/// The cases of the members, read and checked as a run checks them before it writes. `overrides` (`--set`) apply to
/// all. Throws InputError with the problems of all members; IoError if the file cannot be read.
std::vector<CaseSpec> cases_of_sweep(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                                     const SweepPlan& plan);

inline constexpr std::string_view sweep_record_name = "sweep.json";

/// Whether the folder is that of a sweep.
bool is_sweep(const std::filesystem::path& folder);

/// The plan that a sweep has left in its folder. Throws IoError.
SweepPlan read_sweep_record(const std::filesystem::path& folder);
void write_sweep_record(const std::filesystem::path& folder, const SweepPlan& plan);

}  // namespace tailwater
