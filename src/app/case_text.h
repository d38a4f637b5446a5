// Places in the text of a case, whether it can be read or not.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tailwater {

/// First and last line, from 1, of each table of a case's text, by the name of the table.
std::map<std::string, std::vector<std::pair<int, int>>> lines_of_tables(std::string_view text);

/// "particles.spacing": the key whose line this is, or the last one above it, as in a list over several lines;
/// "particles" for the heading of a table; "" before any. Lines count from 1.
std::string key_at(std::string_view text, int line);

/// The column behind the word, text, list or heading that begins in a column; both count from 1.
int end_column(std::string_view text, int line, int column);

}  // namespace tailwater
