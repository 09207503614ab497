// This file reads whole files of RTCM 3, and recognizes them by their beginning.
#include "ppp/readers/streams/epoch_builder.h"
#include "ppp/readers/streams/rtcm3.h"
#include "ppp/readers/streams/rtcm3_ephemeris.h"

namespace maploop::ppp {
namespace {

// Returns the position in a message 1005 or 1006, m, earth-fixed.
std::optional<Eigen::Vector3d> position_of(const Rtcm3Message& message) {
  constexpr double unit = 1e-4;  // m
  if (message.number != 1005 && message.number != 1006) return {};
  Rtcm3Bits bits(message.payload);
  bits.skip(12 + 12 + 6 + 4);
  const double x = unit * static_cast<double>(bits.signed_number(38));
  bits.skip(2);
  const double y = unit * static_cast<double>(bits.signed_number(38));
  bits.skip(2);
  const double z = unit * static_cast<double>(bits.signed_number(38));
  if (!bits.good() || Eigen::Vector3d(x, y, z).norm() < 6e6) return {};
  return Eigen::Vector3d(x, y, z);
}

}  // namespace

bool is_rtcm3(std::string_view bytes) {
  constexpr std::size_t far_enough = 65536;  // behind the text of a receiver's start
  Rtcm3Message message;
  return Rtcm3Frames(bytes.substr(0, far_enough)).next(message);
}

std::optional<GpsTime> week_of(const Rtcm3Message& message) {
  constexpr int era = 2048;  // GPS's weeks are modulo 1024: 2019-04-07 to 2038-11-20
  constexpr int galileo_begin = 1024;
  Rtcm3Bits bits(message.payload);
  bits.skip(12 + 6);
  int number = 0;
  if (message.number == 1019) {
    number = era + static_cast<int>(bits.number(10));
  } else if (message.number == 1045 || message.number == 1046) {
    number = galileo_begin + static_cast<int>(bits.number(12));
  } else {
    return {};
  }
  if (!bits.good()) return {};
  constexpr Duration half_a_week = std::chrono::hours(12 * 7);
  return gps_week_time(number, 0.0) + half_a_week;
}

Observations parse_rtcm3(std::string_view bytes, const std::string& file,
                         NavigationFile* navigation) {
  Observations result;
  result.file = file;
  std::optional<GpsTime> near;
  Rtcm3Message message;
  for (Rtcm3Frames frames(bytes); !near && frames.next(message);) near = week_of(message);
  if (!near) {
    throw ReadError(file +
                    ": RTCM observations do not contain their week, and the file has no ephemeris "
                    "of GPS or Galileo (1019, 1045, 1046), which does; record those too");
  }
  MsmDecoder decoder(*near);
  std::string problem;
  Epoch epoch;
  const auto keep = [&] {
    if (!result.epochs.empty() && epoch.time <= result.epochs.back().time) {
      refuse(result, message.offset,
             "epoch " + format_gps_time(epoch.time) + " is not after the one before");
    } else {
      result.epochs.push_back(epoch);
    }
  };
  Rtcm3Frames frames(bytes);
  while (frames.next(message)) {
    if (const auto position = position_of(message)) {
      result.header.approximate_position = position;
    }
    if (navigation != nullptr) {
      const GpsTime now = result.epochs.empty() ? *near : result.epochs.back().time;
      if (add_ephemeris(message, now, *navigation)) continue;
    }
    if (decoder.decode(message, epoch, problem)) keep();
    if (!problem.empty()) refuse(result, message.offset, problem);
  }
  while (decoder.finish(epoch)) keep();
  if (result.epochs.empty()) throw ReadError(file + ": has no observations (MSM4 to MSM7)");
  result.header.first = result.epochs.front().time;
  result.header.last = result.epochs.back().time;
  result.header.glonass_channels = decoder.glonass_channels();
  if (frames.damaged() > 0) {
    refuse(result, bytes.size(),
           std::to_string(frames.damaged()) + " frames with a wrong checksum, or incomplete");
  }
  if (decoder.dropped() > 0) {
    refuse(result, bytes.size(),
           std::to_string(decoder.dropped()) + " values with unknown signals or impossible ranges");
  }
  return result;
}

}  // namespace maploop::ppp
