// Options of a run from the command line, apart from its case.
#pragma once

#include <filesystem>

#include "run/requests.h"

namespace tailwater {

struct RunOptions {
  std::filesystem::path case_file;  ///< as named in the summary
  std::filesystem::path out;
  bool force = false;  ///< replace the results of an earlier run
  WallTime wall_time;
};

}  // namespace tailwater
