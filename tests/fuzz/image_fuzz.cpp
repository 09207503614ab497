// Images: PNG of one size, PNG and JPEG of any.
#include <stdexcept>
#include <vector>

#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

// What cannot be decoded is refused with its reason.
template <class Decode>
void decode(Decode decode) {
  try {
    decode();
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<char> bytes(data, data + size);
  GreyImage image;
  decode([&] { sensors::decode_grey_png(bytes, 8, 6, image); });
  decode([&] { (void)sensors::decode_any_png(bytes); });
  decode([&] { (void)sensors::decode_grey_jpeg(bytes); });
  return 0;
}
