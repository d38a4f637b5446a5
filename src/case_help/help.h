// The documentation of the case file, generated from the keys themselves.
#pragma once

#include <string>

namespace tailwater {

/// For `tailwater run --help-case`: every key with default, unit, range and meaning, as plain text.
std::string case_help();

/// For `tailwater run --help-case=markdown`: the help as a page, docs/reference/case-file.md.
std::string case_reference_markdown();

/// For `tailwater run --help-case=json`: the help for programs, such as an editor or a generator of cases: {format: 1,
/// functions, tables: [{name, is_list, has_free_keys, documentation, keys: [{name, type, unit, required, default,
/// documentation}]}]}. A key may also have minimum, minimum_is_excluded, maximum, maximum_is_excluded, choices,
/// variables (of its expressions) and goes_with {key, choices, needed_by}: the choices of another key of its table.
std::string case_reference_json();

/// For `tailwater run --help-case=schema`: a JSON schema of case files, with which an editor completes, explains and
/// marks keys. It covers single keys and combinations of keys, but no expressions, shapes or files.
std::string case_schema();

/// For `tailwater run --help-case=study`: the keys that no case needs,
/// docs/reference/study-keys.md.
std::string study_reference_markdown();

/// For `tailwater run --help-case=probes`: the output of each type of probe, docs/reference/probes.md.
std::string probe_reference_markdown();

}  // namespace tailwater
