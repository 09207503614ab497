#include "ppp/readers/streams/rtcm3_signals.h"

#include <array>
#include <cstddef>

namespace maploop::ppp {
namespace {

using Names = std::array<std::string_view, 33>;  // by bit, from 1

struct Entry {
  int place;
  std::string_view name;
};

template <std::size_t n>
constexpr Names table(const Entry (&entries)[n]) {
  Names names{};
  for (const Entry& e : entries) names[static_cast<std::size_t>(e.place)] = e.name;
  return names;
}

constexpr Names gps = table({{2, "1C"},
                             {3, "1P"},
                             {4, "1W"},
                             {8, "2C"},
                             {9, "2P"},
                             {10, "2W"},
                             {15, "2S"},
                             {16, "2L"},
                             {17, "2X"},
                             {22, "5I"},
                             {23, "5Q"},
                             {24, "5X"},
                             {30, "1S"},
                             {31, "1L"},
                             {32, "1X"}});
constexpr Names glonass = table({{2, "1C"}, {3, "1P"}, {8, "2C"}, {9, "2P"}});
constexpr Names galileo = table({{2, "1C"},
                                 {3, "1A"},
                                 {4, "1B"},
                                 {5, "1X"},
                                 {6, "1Z"},
                                 {8, "6C"},
                                 {9, "6A"},
                                 {10, "6B"},
                                 {11, "6X"},
                                 {12, "6Z"},
                                 {14, "7I"},
                                 {15, "7Q"},
                                 {16, "7X"},
                                 {18, "8I"},
                                 {19, "8Q"},
                                 {20, "8X"},
                                 {22, "5I"},
                                 {23, "5Q"},
                                 {24, "5X"}});
constexpr Names sbas = table({{2, "1C"}, {22, "5I"}, {23, "5Q"}, {24, "5X"}});
constexpr Names qzss = table({{2, "1C"},
                              {9, "6S"},
                              {10, "6L"},
                              {11, "6X"},
                              {15, "2S"},
                              {16, "2L"},
                              {17, "2X"},
                              {22, "5I"},
                              {23, "5Q"},
                              {24, "5X"},
                              {30, "1S"},
                              {31, "1L"},
                              {32, "1X"}});
constexpr Names beidou = table({{2, "2I"},
                                {3, "2Q"},
                                {4, "2X"},
                                {8, "6I"},
                                {9, "6Q"},
                                {10, "6X"},
                                {14, "7I"},
                                {15, "7Q"},
                                {16, "7X"},
                                {22, "5D"},
                                {23, "5P"},
                                {24, "5X"},
                                {25, "7D"},
                                {30, "1D"},
                                {31, "1P"},
                                {32, "1X"}});

}  // namespace

std::string_view msm_signal(System system, int place) {
  const auto at = static_cast<std::size_t>(place);
  switch (system) {
    case System::gps:
      return gps[at];
    case System::glonass:
      return glonass[at];
    case System::galileo:
      return galileo[at];
    case System::sbas:
      return sbas[at];
    case System::qzss:
      return qzss[at];
    case System::beidou:
      return beidou[at];
    default:
      return {};
  }
}

std::optional<Satellite> msm_satellite(System system, int place) {
  const int number = system == System::sbas ? place + 19 : place;
  if (number < 1 || number > 99) return {};
  return Satellite{system, static_cast<std::uint8_t>(number)};
}

}  // namespace maploop::ppp
