// Rule bases (FLL), and what they say of a few values.
#include <array>

#include "mapmatch/fll_reader.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  constexpr std::array<std::string_view, 2> inputs{"b", "a"};
  try {
    const auto system = mapmatch::parse_fll(input.text(), "input", inputs);
    for (const double value : {-1e9, 0.0, 5.0, 1e9}) (void)system.evaluate(std::array{value, 1.0});
  } catch (const mapmatch::FllError&) {
  }
  return 0;
}
