// This file finds the key that a syntax error concerns; users of the configuration do not need it.
#pragma once

#include <string>
#include <string_view>

#include "runtime/core/toml.h"

namespace maploop::runtime::detail {

// Returns "fusion.rate: " if the line of `error` in `text` sets that key or opens that table, "in
// [fusion]: " if only the enclosing table is known, otherwise "".
std::string context_of(std::string_view text, const toml::parse_error& error);

}  // namespace maploop::runtime::detail
