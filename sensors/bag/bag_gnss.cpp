#include <cmath>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "sensors/bag/topic_stream.h"
#include "sensors/gnss/velocity_from_positions.h"

namespace maploop::sensors {
namespace {

class FixMaker {
 public:
  FixMaker(SharedBagSettings settings, const Topic& gnss, const Topic* velocity)
      : stream_(std::move(settings), topics(gnss, velocity)),
        gnss_(gnss),
        has_velocity_(velocity != nullptr) {}

  bool next(GnssFix& fix, SourceReport& report) {
    while (const RecordedMessage* message = stream_.next(report)) {
      if (message->topic->name != gnss_.name) {
        RosTwist twist;
        if (!stream_.decoded(*message, twist, report)) continue;
        velocity_ = twist.linear;
        velocity_stamp_ = stream_.stamp(twist.header, *message);
        continue;
      }
      RosFix from;
      if (!stream_.decoded(*message, from, report)) continue;
      if (from.status < 0) {
        stream_.refuse(gnss_, "the receiver had no fix", report);
        continue;
      }
      if (!(std::abs(from.latitude) <= 90.0 && std::abs(from.longitude) <= 360.0 &&
            std::isfinite(from.altitude))) {
        stream_.refuse(gnss_, "its position is not one on Earth", report);
        continue;
      }
      fix.stamp = fix.available = stream_.stamp(from.header, *message);
      fix.sequence = fixes_++;
      if (!stream_.follows(gnss_, fix, report)) continue;
      set_position(from, fix);
      set_velocity(fix);
      return true;
    }
    return false;
  }

 private:
  static std::set<std::string> topics(const Topic& gnss, const Topic* velocity) {
    std::set<std::string> names{gnss.name};
    if (velocity != nullptr) names.insert(velocity->name);
    return names;
  }

  void set_position(const RosFix& from, GnssFix& fix) const {
    fix.position = {radians(from.latitude), radians(from.longitude), from.altitude};
    fix.position_covariance = from.covariance;
    const bool known = from.covariance_type != 0 && from.covariance.diagonal().minCoeff() > 0.0;
    if (known) return;
    const double sigma = stream_.settings().parameters.gnss_position_sigma;
    constexpr double height_share = 1.5;  // heights are worse than the horizontal position
    fix.position_covariance =
        Eigen::Vector3d(sigma, sigma, height_share * sigma).cwiseAbs2().asDiagonal();
  }

  void set_velocity(GnssFix& fix) {
    const double sigma = stream_.settings().parameters.gnss_velocity_sigma;
    constexpr Duration oldest = std::chrono::milliseconds(500);
    VelocityFromPositions::set_unknown(fix);
    if (has_velocity_) {
      if (!velocity_ || !input_limits::within(oldest, velocity_stamp_, fix.stamp)) return;
      fix.velocity_enu = *velocity_;
      fix.velocity_stamp = velocity_stamp_;
      fix.velocity_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
      return;
    }
    derivative_.set_velocity(fix);
  }

  TopicStream stream_;
  Topic gnss_;
  bool has_velocity_;
  std::optional<Eigen::Vector3d> velocity_;
  Time velocity_stamp_{};
  VelocityFromPositions derivative_;
  std::uint64_t fixes_ = 0;
};

// Puts a payload into the frame in which the receiver sent it.
template <class Message>
void append_frame(const Message& message, std::string& ubx) {
  constexpr std::uint8_t rxm = 0x02;
  const auto size = static_cast<std::uint16_t>(message.head.size() + message.list.size());
  std::string frame{static_cast<char>(rxm), static_cast<char>(Message::id),
                    static_cast<char>(size & 0xffU), static_cast<char>(size >> 8U)};
  for (const auto part : {message.head, message.list}) frame.append(part.begin(), part.end());
  std::uint8_t a = 0, b = 0;
  for (const char c : frame) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  ubx += "\xb5\x62";
  ubx += frame;
  ubx += {static_cast<char>(a), static_cast<char>(b)};
}

}  // namespace

std::unique_ptr<Source<GnssFix>> make_bag_gnss(SharedBagSettings settings, const Topic& gnss,
                                               const Topic* velocity) {
  return made_by<GnssFix>(FixMaker(std::move(settings), gnss, velocity));
}

std::string read_bag_ubx(const BagSettings& settings, const Topic& raw, const Topic* subframes,
                         SourceReport& report) {
  std::set<std::string> topics{raw.name};
  if (subframes != nullptr) topics.insert(subframes->name);
  TopicStream stream(std::make_shared<const BagSettings>(settings), std::move(topics));
  std::string ubx;
  while (const RecordedMessage* message = stream.next(report)) {
    const auto take = [&](auto decoded) {
      if (stream.decoded(*message, decoded, report)) append_frame(decoded, ubx);
    };
    message->topic->name == raw.name ? take(RosRawx{}) : take(RosSubframe{});
    if (ubx.size() > input_limits::gnss_file) {
      throw std::runtime_error("'" + settings.path.string() + "' has more observations than " +
                               std::to_string(input_limits::gnss_file) +
                               " bytes; cut the recording into shorter ones");
    }
  }
  return ubx;
}

}  // namespace maploop::sensors
