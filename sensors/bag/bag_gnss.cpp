#include <cmath>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "sensors/bag/topic_stream.h"
#include "sensors/gnss/velocity_from_positions.h"

namespace maploop::sensors {
namespace {

// A velocity belongs to the fix whose stamp is nearest, and its message may come before or after
// that of the fix. So a fix is held until the next message shows which velocity is nearer.
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
        const Velocity velocity{stream_.stamp(twist.header, *message), twist.linear};
        const bool settles = held_ && velocity.stamp >= held_->stamp;
        if (settles) give(fix, &velocity);
        last_velocity_ = velocity;
        if (settles) return true;
        continue;
      }
      std::optional<GnssFix> taken = take(*message, report);
      if (!taken) continue;
      const bool given = held_.has_value();
      if (given) give(fix, nullptr);
      held_ = taken;
      if (given) return true;
      if (!has_velocity_ || (last_velocity_ && last_velocity_->stamp == held_->stamp)) {
        give(fix, nullptr);
        return true;
      }
    }
    if (!held_) return false;
    give(fix, nullptr);
    return true;
  }

 private:
  struct Velocity {
    Time stamp{};
    Eigen::Vector3d enu;
  };

  static std::set<std::string> topics(const Topic& gnss, const Topic* velocity) {
    std::set<std::string> names{gnss.name};
    if (velocity != nullptr) names.insert(velocity->name);
    return names;
  }

  std::optional<GnssFix> take(const RecordedMessage& message, SourceReport& report) {
    RosFix from;
    if (!stream_.decoded(message, from, report)) return std::nullopt;
    if (from.status < 0) {
      stream_.refuse(gnss_, "the receiver had no fix", report);
      return std::nullopt;
    }
    if (!(std::abs(from.latitude) <= 90.0 && std::abs(from.longitude) <= 360.0 &&
          std::isfinite(from.altitude))) {
      stream_.refuse(gnss_, "its position is not one on Earth", report);
      return std::nullopt;
    }
    GnssFix fix;
    fix.stamp = fix.available = stream_.stamp(from.header, message);
    fix.sequence = fixes_++;
    if (!stream_.follows(gnss_, fix, report)) return std::nullopt;
    set_position(from, fix);
    return fix;
  }

  // Gives the held fix, which is available once its velocity is, and after the fix before it.
  void give(GnssFix& fix, const Velocity* following) {
    fix = *held_;
    held_.reset();
    derivative_.set_velocity(fix);
    set_velocity(fix, following);
    fix.available = std::max({fix.available, fix.velocity_stamp, earliest_});
    earliest_ = fix.available + Duration(1);
  }

  // Sets the nearer of the last velocity and of the one that follows.
  void set_velocity(GnssFix& fix, const Velocity* following) const {
    const Velocity* nearest = last_velocity_ ? &*last_velocity_ : following;
    if (following != nullptr && last_velocity_ &&
        following->stamp - fix.stamp < fix.stamp - last_velocity_->stamp) {
      nearest = following;
    }
    constexpr Duration farthest = std::chrono::milliseconds(200);
    if (nearest == nullptr || !input_limits::within(farthest, nearest->stamp, fix.stamp)) return;
    const double sigma = stream_.settings().parameters.gnss_velocity_sigma;
    fix.velocity_enu = nearest->enu;
    fix.velocity_stamp = nearest->stamp;
    fix.velocity_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
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

  TopicStream stream_;
  Topic gnss_;
  bool has_velocity_;
  std::optional<GnssFix> held_;
  std::optional<Velocity> last_velocity_;
  Time earliest_{};  // at which the next fix can be available
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
