// Rules of the schema of case files beyond single keys: rules for combinations of keys, as table_rules.cpp and its
// neighbours check them. Only those that a JSON schema can express: no arithmetic, no expressions, no names of other
// tables.
#pragma once

#include <string_view>

#include "base/json.h"

namespace tailwater {

/// Schemas that a table of that name must all fulfil; an empty list if there are none.
Json table_rules_of_schema(std::string_view table);

/// Schemas that the whole file must all fulfil.
Json file_rules_of_schema();

/// Rules for a file in 2 or in 3 dimensions, besides the length of its vectors.
Json dimension_rules_of_schema(int dimension);

}  // namespace tailwater
