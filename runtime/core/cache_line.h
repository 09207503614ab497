// How far apart data of two threads must lie so that neither slows the other's.
#pragma once

#include <cstddef>

namespace maploop::runtime {

inline constexpr std::size_t kCacheLine = 64;  // bytes: what one core takes from another

// bytes: Intel's adjacent-line prefetcher fetches lines in pairs, so a neighbour line is shared
// too.
inline constexpr std::size_t kNoSharing = 2 * kCacheLine;

}  // namespace maploop::runtime
