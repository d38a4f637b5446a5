// The keys that belong to each shape, type or choice of a block, wall, probe or scheme. This rule is stated here only.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "case/key_info.h"
#include "case/spec.h"

namespace tailwater {

/// The keys that one choice needs or may have. A key that is in no row of its table is allowed with every choice.
struct KeyUse {
  std::string_view table;
  std::string_view selector;  ///< the key whose value chooses
  std::string_view choice;
  std::vector<std::string_view> needed;
  std::vector<std::string_view> possible;

  bool needs(std::string_view key) const;
  bool mentions(std::string_view key) const;  ///< as needed or possible
};

std::span<const KeyUse> key_uses();

enum class KeyNeed { free, needed, possible, unused };

/// The need for `key` under the choices made in `rows`, the keys of one table called `table`. `use` is the decisive
/// row, null if the need is free.
struct KeyVerdict {
  KeyNeed need = KeyNeed::free;
  const KeyUse* use = nullptr;
};
KeyVerdict key_verdict(std::string_view table, std::string_view key, std::span<const KeyInfo> rows);

/// Whether a scheme has the part that this key of [study] changes.
bool has_study(const SchemeTable& scheme, std::string_view key);

/// For the help: `shape = "box"`, or `type = "depth", "pressure"`, with "(needed)" where it is needed; empty if the key
/// is allowed with every choice.
std::string key_use_text(std::string_view table, std::string_view key);

}  // namespace tailwater
