#include "case_help/migration.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "case/case_toml.h"
#include "case/problems.h"
#include "case/removed_keys.h"
#include "case/spec.h"

namespace tailwater {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// The lines of a case file. Changes use the line numbers of the old file; added text stands after one of its lines. A
/// byte order mark stays in front, and added lines end as those of the file.
class Lines {
 public:
  explicit Lines(std::string_view text) : ends_in_cr_lf_(text.find("\r\n") != std::string_view::npos) {
    if (text.starts_with(byte_order_mark)) {
      mark_ = byte_order_mark;
      text.remove_prefix(byte_order_mark.size());
    }
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size() - 1);
      lines_.push_back({std::string(text.substr(0, end + 1)), ""});
      text.remove_prefix(end + 1);
    }
    if (!lines_.empty() && !lines_.back().text.ends_with('\n')) lines_.back().text += ends_in_cr_lf_ ? "\r\n" : "\n";
  }

  /// `number` counts from 1, as in messages.
  std::string& at(std::size_t number) { return lines_[number - 1].text; }
  std::size_t last() const { return lines_.size(); }

  /// 0: before the first.
  void add_after(std::size_t number, std::string_view text) {
    std::string& added = number == 0 ? before_ : lines_[number - 1].added;
    for (const char character : text) {
      if (character == '\n' && ends_in_cr_lf_ && !added.ends_with('\r')) added += '\r';
      added += character;
    }
  }

  std::string text() const {
    std::string all = mark_ + before_;
    for (const Line& line : lines_) all += line.text + line.added;
    return all;
  }

 private:
  struct Line {
    std::string text;
    std::string added;
  };
  bool ends_in_cr_lf_;
  std::string mark_;
  std::string before_;
  std::vector<Line> lines_;
};

/// The number of the line [name]; none if the table is written in another way, or absent.
std::optional<std::size_t> header_of(const toml::table& root, std::string_view name, Lines& lines) {
  const toml::table* table = root[name].as_table();
  if (table == nullptr) return std::nullopt;
  const std::size_t line = table->source().begin.line;
  const std::string& text = lines.at(line);
  return text[text.find_first_not_of(" \t")] == '[' ? std::optional(line) : std::nullopt;
}

/// A key of the file with its value as written.
struct Entry {
  const RemovedKey& key;
  const toml::node& value;
  std::size_t first_line;
  std::size_t last_line;
};

class Migrator {
 public:
  Migrator(std::string_view text, const std::string& file)
      : file_(file), root_(parse_case(text, file)), lines_(text), text_(text) {}

  Migration result() {
    const auto format = root_["case"]["format"].value<std::int64_t>();
    if (format && *format > case_format) {
      throw InputError("{}: its format is {}, and this program reads formats up to {}; use a newer version", file_,
                       *format, case_format);
    }
    for (const RemovedKey& key : removed_keys()) {
      if (const std::optional<Entry> entry = find(key)) change(*entry);
    }
    if (!studies_.empty()) add_studies();
    if (!format) {
      add_format();
      look_at_outlets();
      for (const char* kind : {"inlet", "outlet"}) look_at_levels(kind);
    }
    std::ranges::sort(changes_, {}, &Change::line);
    Migration migration{changes_.empty() ? std::string(text_) : lines_.text(), {}};
    for (const Change& made : changes_) {
      migration.changes.push_back(fmt::format("{}:{}: {}", file_, made.line, made.text));
    }
    parse_case(migration.text, fmt::format("{}, brought up to date", file_));
    return migration;
  }

 private:
  struct Change {
    std::size_t line;
    std::string text;
  };

  std::optional<Entry> find(const RemovedKey& key) {
    const toml::table* table = root_[key.table].as_table();
    if (table == nullptr) return std::nullopt;
    for (const auto& [name, value] : *table) {
      if (name.str() != key.key) continue;
      const std::size_t first = name.source().begin.line;
      if (table->is_inline()) {
        throw InputError(
            "{}:{}: {}.{} stands in braces; write the keys of this table on lines below [{}], and migrate the file "
            "then",
            file_, first, key.table, key.key, key.table);
      }
      return Entry{key, value, first, value.source().end.line};
    }
    return std::nullopt;
  }

  /// The studies change the robust formulation only.
  bool is_published() const { return root_["scheme"]["formulation"].value_or(std::string_view()) == "published"; }

  void change(const Entry& entry) {
    const bool is_kind_of_shifting = entry.key.key == "shifting";
    const bool is_off = root_["scheme"]["shifting"].value_or(std::string_view()) == "none";
    const bool has_value_today = is_kind_of_shifting ? is_off : entry.key.key != "shifting_strength" || !is_off;
    if (entry.key.successor.empty() || is_published() || !has_value_today) {
      comment_out(entry);
    } else {
      move(entry, is_kind_of_shifting ? "0" : "");
    }
  }

  void comment_out(const Entry& entry) {
    lines_.at(entry.first_line).insert(0, "# removed: ");
    for (std::size_t line = entry.first_line + 1; line <= entry.last_line; ++line) lines_.at(line).insert(0, "# ");
    changes_.push_back({entry.first_line, fmt::format("{}.{} = {} is a comment now: it {}", entry.key.table,
                                                      entry.key.key, value_text(entry.value), entry.key.fate)});
  }

  /// Moves a key with its comment; `value`, if there is one, replaces its own value.
  void move(const Entry& entry, const std::string& value) {
    std::string moved;
    for (std::size_t line = entry.first_line; line <= entry.last_line; ++line) {
      moved += lines_.at(line);
      lines_.at(line).clear();
    }
    const std::string rest = value.empty()
                                 ? moved.substr(moved.find('='))
                                 : fmt::format("= {}{}", value, moved.substr(entry.value.source().end.column - 1));
    studies_ += fmt::format("{} {}", entry.key.successor, rest);
    changes_.push_back({entry.first_line, fmt::format("{}.{} is study.{} now{}", entry.key.table, entry.key.key,
                                                      entry.key.successor, value.empty() ? "" : " = " + value)});
  }

  void add_studies() {
    if (const auto header = header_of(root_, "study", lines_)) {
      lines_.add_after(*header, studies_);
    } else {
      lines_.add_after(lines_.last(), "\n[study]\n" + studies_);
    }
  }

  void add_format() {
    const std::string line = fmt::format("format = {}\n", case_format);
    const auto header = header_of(root_, "case", lines_);
    if (header) {
      lines_.add_after(*header, line);
    } else {
      lines_.add_after(0, "case." + line);
    }
    changes_.push_back({header.value_or(1), fmt::format("case.format = {} is written down", case_format)});
  }

  /// Reports outlets without a definition of the far side; their owner must decide whether one is a hole.
  void look_at_outlets() {
    const toml::array* outlets = root_["outlet"].as_array();
    for (std::size_t k = 0; outlets != nullptr && k < outlets->size(); ++k) {
      const toml::table* outlet = (*outlets)[k].as_table();
      if (outlet == nullptr || outlet->contains("level") || outlet->contains("file")) continue;
      changes_.push_back({outlet->source().begin.line,
                          fmt::format("outlet[{}] is a channel that continues, as before; if it is a hole in a wall, "
                                      "give beyond = \"air\", or the level beyond, and leave the pit out",
                                      k)});
    }
  }

  /// Reports openings with a level. Their level was held on average, with the waves let out.
  void look_at_levels(const char* kind) {
    const toml::array* openings = root_[kind].as_array();
    for (std::size_t k = 0; openings != nullptr && k < openings->size(); ++k) {
      const toml::table* opening = (*openings)[k].as_table();
      if (opening == nullptr || !opening->contains("level") || opening->contains("absorbing")) continue;
      changes_.push_back({opening->source().begin.line,
                          fmt::format("{}[{}] holds its level at any instant now, and reflects waves; for a steady "
                                      "flow give absorbing = 0.3, to let waves out absorbing = 1",
                                      kind, k)});
    }
  }

  const std::string& file_;
  toml::table root_;
  Lines lines_;
  std::string_view text_;
  std::string studies_;
  std::vector<Change> changes_;
};

}  // namespace

Migration migrate_case(std::string_view text, const std::string& file) { return Migrator(text, file).result(); }

}  // namespace tailwater
