// The text (JSON) of a checkpoint: all data that are the same on all ranks, except arrays of numbers.
#pragma once

#include <string>

#include "run/checkpoint.h"

namespace tailwater {

template <int Dim>
std::string text_of(const Checkpoint<Dim>& checkpoint);

/// Throws Json::exception or IoError for text that is not of a checkpoint.
template <int Dim>
void take_text(const std::string& text, Checkpoint<Dim>& checkpoint);

/// Throws IoError, which names the `part`, unless the condition holds.
void require_fit(bool condition, const char* part);

}  // namespace tailwater
