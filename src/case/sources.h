// Where the tables and keys of a case stand in its file, for what is found wrong after it has been read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

class CaseSources {
 public:
  /// What messages call a thing, "wall 'tank'" or "particles.spacing", and its place, "case.toml:12:1".
  void add(std::string name, std::string place) { entries_.push_back({std::move(name), std::move(place)}); }

  /// Each line of the message behind the place of what it names first; a line that names nothing stays as it is. In
  /// "wall 'tank': points[0] ..." the key `points` of that wall is named.
  std::string placed(std::string_view message) const;

  /// Where a value was written is no part of the case.
  bool operator==(const CaseSources&) const { return true; }

 private:
  struct Entry {
    std::string name;
    std::string place;
  };

  std::string_view place_of(std::string_view line) const;

  std::vector<Entry> entries_;
};

}  // namespace tailwater
