// What the schema of case files says beyond single keys: rules of keys that go together, as table_rules.cpp and its
// neighbours check them. Only what a JSON schema can see: no arithmetic, no expressions, no names of other tables.
#pragma once

#include <string_view>

#include "base/json.h"

namespace tailwater {

/// Schemas that a table of that name must all fulfil; an empty list if there are none.
Json table_rules_of_schema(std::string_view table);

/// Schemas that the whole file must all fulfil.
Json file_rules_of_schema();

/// What the file must fulfil in 2 or in 3 dimensions, besides the length of its vectors.
Json dimension_rules_of_schema(int dimension);

}  // namespace tailwater
