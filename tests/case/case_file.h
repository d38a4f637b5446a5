// A case file that is deleted at the end of a test.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "case/reader.h"

namespace tailwater {

class CaseFile {
 public:
  explicit CaseFile(const std::string& text)
      : folder_(std::filesystem::temp_directory_path() / fmt::format("tailwater-case-{}", getpid())) {
    std::filesystem::create_directories(folder_);
    std::ofstream(path()) << text;
  }
  ~CaseFile() { std::filesystem::remove_all(folder_); }
  CaseFile(const CaseFile&) = delete;
  CaseFile& operator=(const CaseFile&) = delete;

  std::filesystem::path path() const { return folder_ / "case.toml"; }

 private:
  std::filesystem::path folder_;
};

inline CaseSpec read_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const CaseFile file(text);
  return read_case(file.path(), overrides);
}

/// The error message of reading the text. If reading succeeds, the test fails and the message is empty.
inline std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_text(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError for\n" << text;
  return {};
}

inline int line_count(const std::string& message) {
  return 1 + static_cast<int>(std::count(message.begin(), message.end(), '\n'));
}

/// The shortest valid case: the required keys, and one block of water in 2D.
inline const std::string required_keys = "particles.spacing = 0.1\ntime.end = 1.0\n";
inline const std::string water = "[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\n";
inline const std::string mud = water + "liquid = \"mud\"\n";

}  // namespace tailwater
