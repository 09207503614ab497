// Drives of tables: every sensor to its end, by increasing times that do not leap. Lines that begin
// with '#' part the input into the files.
#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "msgs/input_limits.h"
#include "sensors/folder/table_recording.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

template <class T>
void read(std::unique_ptr<sensors::Source<T>> source) {
  Time last = Time::min();
  for (T sample; source->next(sample); last = sample.stamp) {
    fuzz::require(last == Time::min() ||
                  (sample.stamp > last &&
                   input_limits::within(input_limits::longest_gap, last, sample.stamp)));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::NamedFile first("gnss.csv");
  const auto folder = first.path().parent_path();
  std::string_view text = fuzz::Input(data, size).text();
  for (const char* name :
       {"gnss.csv", "imu.csv", "reference_position.csv", "reference_attitude.csv"}) {
    const std::size_t end = std::min(text.find("#\n"), text.size());
    std::ofstream(folder / name, std::ios::binary) << text.substr(0, end);
    text.remove_prefix(std::min(end + 2, text.size()));
    if (text.empty()) break;
  }
  try {
    const sensors::TableRecording recording(folder);
    read(recording.gnss());
    if (recording.has_imu()) {
      for (const bool given : {false, true}) {
        read<ImuSample>(recording.imu(recording.gnss(), {given}, 1.0));
      }
    }
    if (recording.has_reference()) read(recording.reference());
  } catch (const std::runtime_error&) {
  }
  return 0;
}
