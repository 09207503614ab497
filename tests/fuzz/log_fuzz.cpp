// LCM logs: what can be read of any bytes, and that what is recovered from them is read again.
#include <sstream>
#include <stdexcept>

#include "msgs/lcm/checked_decode.h"
#include "tests/fuzz/fuzz_input.h"
#include "tools/log/log_tools.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::NamedFile log("damaged.lcmlog"), recovered("recovered.lcmlog");
  log.write({data, size});
  std::ostringstream out;
  try {
    lcm_log::verify(log.path(), schema::own_schema(), out);
    const auto recovery = lcm_log::recover(log.path(), schema::own_schema(), recovered.path(), out);
    const auto sound = lcm_log::verify(recovered.path(), schema::own_schema(), out);
    fuzz::require(sound.events == recovery.events);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
