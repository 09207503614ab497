// What the conversions share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "msgs/time.h"

namespace maploop {

inline std::int64_t microseconds_of(Time t) {
  return std::chrono::floor<std::chrono::microseconds>(t).time_since_epoch().count();
}

template <class In, class Out>
void convert_each(const std::vector<In>& in, std::vector<Out>& out, Out (*convert)(const In&)) {
  out.resize(in.size());
  std::transform(in.begin(), in.end(), out.begin(), convert);
}

}  // namespace maploop
