// This file defines how far apart the data of two threads must lie so that neither slows down the
// other.
#pragma once

#include <cstddef>

namespace maploop::runtime {

inline constexpr std::size_t cache_line = 64;  // bytes: the unit that cores transfer

// bytes: Intel's adjacent-line prefetcher fetches lines in pairs, so a neighbouring line is shared
// too.
inline constexpr std::size_t no_sharing = 2 * cache_line;

}  // namespace maploop::runtime
