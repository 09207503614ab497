// Which key a syntax error is about; not for users of the configuration.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <string_view>

namespace maploop::runtime::detail {

// "fusion.rate: " where the line of `error` in `text` sets that key or opens that table,
// "in [fusion]: " where it can only be said which table it stands in, else "".
std::string context_of(std::string_view text, const toml::parse_error& error);

}  // namespace maploop::runtime::detail
