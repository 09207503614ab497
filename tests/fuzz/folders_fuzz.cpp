// The texts and arrays of folders of other data sets: the first byte says which reader gets the
// rest. Stamps that are kept increase without leaps.
#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "msgs/input_limits.h"
#include "sensors/folder/euroc.h"
#include "sensors/folder/image_lists.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/stamps.h"
#include "sensors/folder/table_recording.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

namespace {

void check(const NumberCells& cells) {
  fuzz::require(cells.columns.size() <= input_limits::columns || cells.values.empty());
  fuzz::require(cells.values.empty() || cells.values.size() % cells.columns.size() == 0);
}

void read_list(std::string_view text) {
  const ImageFolder list = parse_image_list(text, "folder/left.txt");
  fuzz::require(list.names.size() == list.timestamps.size());
  const ImagePair pair = paired(list, list, Duration(1));
  fuzz::require(pair.left.names.size() == pair.right.names.size());
}

// A table of an inertial unit and fixes, with every form of time and position.
void read_table(std::span<const std::uint8_t> bytes, unsigned form) {
  const fuzz::NamedFile file("table.csv");
  file.write(bytes);
  TableMapping mapping;
  mapping.utc_of_gps = [](Time gps) { return gps - std::chrono::seconds(18); };
  mapping.gnss.file = file.path();
  mapping.gnss.time_unit = static_cast<TimeUnit>(form % 5U);
  mapping.gnss.time = {"t"};
  if (mapping.gnss.time_unit == TimeUnit::gps_week) mapping.gnss.time = {"t", "tow"};
  mapping.gnss.form = static_cast<PositionForm>(form / 5U % 3U);
  mapping.gnss.position = {{"x", "y", "z"}};
  mapping.gnss.gps_time = form % 2U == 1;
  const TableRecording recording(mapping);
  const auto source = recording.gnss();
  Time last = Time::min();
  for (GnssFix fix; source->next(fix); last = fix.stamp) {
    fuzz::require(
        last == Time::min() ||
        (fix.stamp > last && input_limits::within(input_limits::longest_gap, last, fix.stamp)));
  }
}

void read_euroc(std::span<const std::uint8_t> bytes) {
  const fuzz::NamedFile file("mav0");
  for (const char* camera : {"cam0", "cam1"}) {
    std::filesystem::create_directories(file.path() / camera);
    std::ofstream out(file.path() / camera / "sensor.yaml", std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }
  (void)read_euroc_calibration(file.path());
}

void read_times_of(std::span<const std::uint8_t> bytes) {
  const fuzz::NamedFile file("times.txt");
  file.write(bytes);
  const std::vector<Time> stamps = read_times(file.path());
  fuzz::require(std::ranges::is_sorted(stamps));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const unsigned kind = input.byte();
  const auto bytes = input.rest();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    switch (kind % 6U) {
      case 0:
        check(parse_npy(text, {{"a", "b", "c"}, "a", true}));
        break;
      case 1:
        check(parse_pos(text));
        break;
      case 2:
        read_list(text);
        break;
      case 3:
        read_table(bytes, kind / 6U);
        break;
      case 4:
        read_times_of(bytes);
        break;
      default:
        read_euroc(bytes);
        break;
    }
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
