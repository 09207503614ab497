// Messages of our own types from anybody: what the schema lets through, LCM's code decodes.
#include <maploop_lcm/calibration_t.hpp>
#include <maploop_lcm/deadlines_t.hpp>
#include <maploop_lcm/gnss_fix_t.hpp>
#include <maploop_lcm/health_t.hpp>
#include <maploop_lcm/lidar_scan_t.hpp>
#include <maploop_lcm/map_doubt_t.hpp>
#include <maploop_lcm/map_feedback_t.hpp>
#include <maploop_lcm/map_match_t.hpp>
#include <maploop_lcm/nav_state_t.hpp>
#include <maploop_lcm/ppp_state_t.hpp>
#include <maploop_lcm/preview_t.hpp>
#include <maploop_lcm/replay_control_t.hpp>
#include <maploop_lcm/stereo_pair_t.hpp>
#include <stdexcept>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

// As it is, and with the fingerprint in front that the type has.
template <class Message>
void decode(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> whole;
  for (int shift = 56; shift >= 0; shift -= 8) {
    whole.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(Message::getHash()) >>
                                              static_cast<unsigned>(shift)));
  }
  whole.insert(whole.end(), bytes.begin(), bytes.end());
  Message message{};
  if (!schema::checked_decode(schema::own_schema(), whole, message)) return;
  try {
    if constexpr (requires { from_lcm(message); }) (void)from_lcm(message);
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace maploop_lcm;
  fuzz::Input input(data, size);
  const auto kind = input.byte() % 13U;
  const auto bytes = input.rest();
  switch (kind) {
    case 0:
      decode<calibration_t>(bytes);
      break;
    case 1:
      decode<deadlines_t>(bytes);
      break;
    case 2:
      decode<gnss_fix_t>(bytes);
      break;
    case 3:
      decode<health_t>(bytes);
      break;
    case 4:
      decode<lidar_scan_t>(bytes);
      break;
    case 5:
      decode<map_feedback_t>(bytes);
      break;
    case 6:
      decode<map_match_t>(bytes);
      break;
    case 7:
      decode<nav_state_t>(bytes);
      break;
    case 8:
      decode<ppp_state_t>(bytes);
      break;
    case 9:
      decode<preview_t>(bytes);
      break;
    case 10:
      decode<replay_control_t>(bytes);
      break;
    case 11:
      decode<stereo_pair_t>(bytes);
      break;
    default:
      decode<map_doubt_t>(bytes);
      break;
  }
  return 0;
}
