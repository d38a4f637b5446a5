// Positions of the tables and keys of a case in its file, for findings after it has been read.
#pragma once

#include <array>
#include <map>
#include <string>

#include "base/finding.h"

namespace tailwater {

class CaseSources {
 public:
  /// Adds a table with its last line, or a key. The label of a table in a list has its index and its name.
  void add(const CaseLabel& label, FilePosition position, int last_line = 0);

  /// The findings with the position of their key, or else of their table, and with the index of the table.
  Findings located(Findings findings) const;

  /// First and last line of a table in the file; empty for a table from an override.
  std::optional<std::array<int, 2>> lines(const CaseLabel& table) const;

  /// The position of a value is no part of the case.
  bool operator==(const CaseSources&) const { return true; }

 private:
  struct Entry {
    std::optional<int> index;
    FilePosition position;
    int last_line;
  };
  const Entry* find(const CaseLabel& label) const;

  std::map<std::array<std::string, 3>, Entry> entries_;  ///< by table, name and key
};

}  // namespace tailwater
