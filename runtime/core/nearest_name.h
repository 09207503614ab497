// This file finds the "Did you mean ...?" for names that a user typed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace maploop::runtime {

// Returns how many letters to insert, delete, replace, or swap with their neighbour (Damerau's four
// errors; optimal string alignment: no letter is edited twice).
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the candidate closest to `name` (the first of equals), or "" if all differ by more than
// half of name's length: a worse guess misleads.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace maploop::runtime
