#include "results/provenance.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "linear/session.h"
#include "version.h"

namespace tailwater {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

}  // namespace

Json provenance() {
  return {{"version", version},
          {"commit", commit},
          {"compiler", compiler},
          {"options", options},
          {"libraries", linear_library_version()},
          {"machine",
           {{"name", host_name()}, {"processor", processor_name()}, {"cores", std::thread::hardware_concurrency()}}}};
}

std::string version_line() { return fmt::format("tailwater {} (commit {})", version, commit); }

}  // namespace tailwater
