#include "runtime/vehicle/config/kept_ppp.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/whole_file.h"

namespace maploop::vehicle {
namespace {

template <class Archive>
void describe(Archive& ar, auto& car, auto& filter) {
  ar.section("kept ppp", 1);
  ar(car, filter);
}

}  // namespace

void write_kept_ppp(const std::filesystem::path& file, const std::string& car,
                    const Bytes& filter) {
  write_whole_file(file, sealed_archive([&](auto& ar) { describe(ar, car, filter); }));
}

std::optional<Bytes> read_kept_ppp(const std::filesystem::path& file, const std::string& car) {
  const std::string cannot = "cannot use '" + file.string() + "': ";
  if (!std::filesystem::exists(file)) return std::nullopt;
  std::string of;
  Bytes filter;
  try {
    read_archive(file, input_limits::snapshot, [&](auto& ar) { describe(ar, of, filter); });
  } catch (const ArchiveError& e) {
    throw DamagedCarState(cannot + e.what());
  } catch (const FileError& e) {
    throw std::runtime_error(cannot + e.reason());
  }
  if (of != car) {
    throw std::runtime_error(cannot +
                             fmt::format("it is of the car '{}', and this is '{}'; name another "
                                         "file with --state",
                                         of, car));
  }
  return filter;
}

}  // namespace maploop::vehicle
