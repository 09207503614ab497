// Configurations.
#include <array>
#include <string>

#include "runtime/core/config.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  try {
    const auto document = runtime::ConfigDocument::parse(input.text(), "input");
    const auto table = document.root();
    double number = 0.0;
    int count = 0;
    bool flag = false;
    std::string text;
    std::array<double, 3> lever{};
    table.read("number", number);
    table.read("count", count);
    table.read("flag", flag);
    table.read("text", text);
    table.read("lever", lever);
    document.reject_unknown();
  } catch (const runtime::ConfigError&) {
  }
  return 0;
}
