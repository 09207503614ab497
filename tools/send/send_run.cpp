#include "tools/send/send_run.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/prefetched_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/clock/host_clock.h"
#include "sensors/imu/ncom_packet.h"
#include "sensors/live/datagram_sender.h"
#include "sensors/live/video_sender.h"
#include "sensors/replay/reference_trajectory.h"
#include "sensors/velodyne/packet_encoder.h"
#include "tools/command/terminal.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/replay/nav_files.h"

namespace maploop::tools {
namespace {

using std::chrono::milliseconds;

constexpr Duration lead = std::chrono::seconds(1);
// A receiver takes so long from an epoch to its sentences.
constexpr Duration gnss_latency = milliseconds(50);

struct Turn : Sample {
  sensors::EncodedTurn packets;
};

class TurnSource final : public sensors::Source<Turn> {
 public:
  TurnSource(std::unique_ptr<sensors::Source<LidarScan>> scans, const sensors::Hdl64Lasers& lasers)
      : scans_(std::move(scans)), encoder_(lasers) {}

  bool next(Turn& turn) override {
    if (!scans_->next(scan_)) return false;
    static_cast<Sample&>(turn) = scan_;
    turn.available = scan_.start;
    encoder_.encode(scan_, turn.packets);
    return true;
  }
  const sensors::SourceReport& report() const override { return scans_->report(); }

 private:
  std::unique_ptr<sensors::Source<LidarScan>> scans_;
  sensors::Hdl64Encoder encoder_;
  LidarScan scan_;
};

// The drive's times, on this machine's clock.
class Schedule {
 public:
  Schedule(Time first, double seconds)
      : shift_(clock_.now() + lead - first),
        end_(seconds > 0.0 ? first + from_seconds(seconds) : Time::max()) {}

  Time shifted(Time t) const { return t + shift_; }
  Duration shift() const { return shift_; }
  Duration late(Time t) const { return clock_.now() - shifted(t); }
  Time end() const { return end_; }
  // False when it is to end before t.
  bool wait(Time t) const {
    if (t > end_) return false;
    while (!interrupted()) {
      const Duration left = shifted(t) - clock_.now();
      if (left <= Duration::zero()) return true;
      std::this_thread::sleep_for(std::min<Duration>(left, milliseconds(100)));
    }
    return false;
  }

 private:
  sensors::HostClock clock_;
  Duration shift_;
  Time end_;
};

// The messages that one thread has sent.
struct Sent {
  std::uint64_t messages = 0, refused = 0;
  Duration latest{};  // the longest that a message left after it was due
  void add(bool taken, Duration late) {
    ++(taken ? messages : refused);
    latest = std::max(latest, late);
  }
};

void send_turns(sensors::Source<Turn>& turns, const sensors::DatagramSender& to,
                const Schedule& schedule, Sent& sent) {
  Turn turn;
  while (turns.next(turn)) {
    const auto& packets = turn.packets.packets;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      sensors::TimedPacket packet = packets[i];
      // It leaves when it is full: with the first firing of the next one.
      const Duration period =
          packets.size() > 1 ? packets[1].first_firing - packets[0].first_firing : Duration::zero();
      if (!schedule.wait(packet.first_firing + period)) return;
      packet.set_time(schedule.shifted(packet.first_firing));
      sent.add(to.send(packet.bytes), schedule.late(packet.first_firing + period));
    }
  }
}

void send_imu(sensors::Source<ImuSample>& samples, const sensors::DatagramSender& to,
              const Schedule& schedule, Sent& sent) {
  ImuSample s;
  while (samples.next(s) && schedule.wait(s.available)) {
    // The unit stamps what it sends with now, though its filters are late.
    const Time now = schedule.shifted(s.available);
    const auto ms = std::chrono::round<milliseconds>(now.time_since_epoch()) % 60'000;
    sent.add(to.send(sensors::ncom_packet(static_cast<std::uint16_t>(ms.count()), s.values())),
             schedule.late(s.available));
  }
}

void send_gnss(sensors::Source<GnssFix>& fixes, const sensors::DatagramSender& to,
               const Schedule& schedule, Sent& sent) {
  GnssFix fix;
  while (fixes.next(fix) && schedule.wait(fix.available + gnss_latency)) {
    GnssFix shifted = fix;
    shifted.stamp = schedule.shifted(fix.stamp);
    const std::string text = nmea_sentences(shifted);
    sent.add(to.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}),
             schedule.late(fix.available + gnss_latency));
  }
}

void send_images(sensors::Source<StereoPair>& pairs, sensors::VideoSender& to,
                 const Schedule& schedule, Sent& sent) {
  StereoPair pair;
  while (pairs.next(pair) && schedule.wait(pair.available)) {
    const Duration late = schedule.late(pair.available);
    sent.add(to.send(pair, late), late);
  }
}

sensors::Hdl64Lasers lasers_of(const vehicle::Recording& recording) {
  const auto scans = recording.sensors(Time::min()).velodyne;
  LidarScan scan;
  if (scans == nullptr || !scans->next(scan)) {
    throw std::runtime_error("the drive has no LiDAR scan to send");
  }
  const auto lasers = sensors::fit_lasers(scan.points);
  if (!lasers) {
    throw std::runtime_error(
        "the first scan of the drive is not that of an HDL-64E, laser by laser: only KITTI's raw "
        "drives can be sent as its packets");
  }
  return *lasers;
}

void write_truth(const std::filesystem::path& file, const vehicle::Recording& recording,
                 Duration shift) {
  const auto rows = sensors::read_rows(recording.sensors(Time::max()).reference);
  if (rows.size() < 2) throw std::runtime_error("the drive has no reference for --truth");
  const sensors::ReferenceTrajectory reference(rows, LocalFrame(rows.front().position));
  evaluation::StampedTrajectory truth;
  for (Time t = rows.front().stamp; t <= rows.back().stamp; t += milliseconds(1)) {
    const auto pose = reference.pose(t);
    if (!pose) continue;
    truth.stamps.push_back(t + shift);
    truth.poses.push_back(*pose * recording.calibration.stereo.T_body_cam);
  }
  evaluation::write_tum(file, truth);
}

// What is sent of a drive, each kind by a thread of its own, from one moment on.
class Sending {
 public:
  Sending(const SendOptions& options, const vehicle::Recording& recording)
      : options_(options), recording_(recording) {}

  void add_camera(std::unique_ptr<sensors::Source<StereoPair>> source) {
    if (source == nullptr) throw std::runtime_error("the drive has no images to send");
    const StereoCalibration& cameras = recording_.calibration.stereo;
    const double rate = static_cast<double>(recording_.images - 1) /
                        to_seconds(recording_.last_stamp - recording_.first_stamp);
    const auto to = std::make_shared<sensors::VideoSender>(options_.camera, cameras.width,
                                                           cameras.height, rate);
    add("camera", send_images, to, prefetched("decoder", 6, std::move(source)));
  }

  void add_velodyne(std::unique_ptr<sensors::Source<LidarScan>> source,
                    const sensors::Hdl64Lasers& lasers) {
    add("velodyne", send_turns, sender(options_.velodyne),
        prefetched<Turn>("encoder", 4, std::make_unique<TurnSource>(std::move(source), lasers)));
  }

  template <class T, class SendAll>
  void add_lines(const char* name, const std::string& endpoint, SendAll send_all,
                 std::unique_ptr<sensors::Source<T>> source) {
    if (endpoint.empty()) return;
    if (source == nullptr) throw std::runtime_error("the drive has nothing to send to " + endpoint);
    add(name, send_all, sender(endpoint), std::shared_ptr<sensors::Source<T>>(std::move(source)));
  }

  bool empty() const { return senders_.empty(); }

  // Until everything is sent, or the end comes. Returns what the drive's times were shifted by.
  Duration run() {
    const Schedule schedule(recording_.first_stamp, options_.seconds);
    {
      std::vector<std::jthread> threads;
      for (Sender& s : senders_)
        threads.emplace_back([&s, &schedule] { s.send(schedule, s.sent); });
    }
    stop_.request_stop();
    return schedule.shift();
  }

  void print() const {
    for (const auto& [name, send, sent] : senders_) {
      if (sent.messages + sent.refused == 0) continue;
      fmt::print("{:9} {:8} messages, up to {:.0f} ms late", name, sent.messages,
                 1e3 * to_seconds(sent.latest));
      if (sent.refused > 0) fmt::print(", {} not taken by the system", sent.refused);
      fmt::print("\n");
    }
  }

 private:
  struct Sender {
    const char* name;
    std::function<void(const Schedule&, Sent&)> send;
    Sent sent;
  };

  static std::shared_ptr<sensors::DatagramSender> sender(const std::string& endpoint) {
    return std::make_shared<sensors::DatagramSender>(sensors::parse_endpoint(endpoint));
  }

  template <class T>
  std::shared_ptr<sensors::Source<T>> prefetched(const char* thread, std::size_t ahead,
                                                 std::unique_ptr<sensors::Source<T>> source) {
    return std::make_shared<vehicle::PrefetchedSource<T>>(
        thread, runtime::Scheduling{}, std::move(source), ahead, stop_.get_token(), nullptr);
  }

  void add(const char* name, auto send_all, auto to, auto from) {
    senders_.push_back(
        {name,
         [=](const Schedule& schedule, Sent& sent) { send_all(*from, *to, schedule, sent); },
         {}});
  }

  const SendOptions& options_;
  const vehicle::Recording& recording_;
  std::stop_source stop_;
  std::vector<Sender> senders_;
};

}  // namespace

int send(const SendOptions& options) {
  const vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  const vehicle::Recording recording = vehicle::open_recording(options.drive, config);
  vehicle::Sensors s = recording.sensors(Time::min());
  Sending sending(options, recording);
  if (!options.camera.empty()) sending.add_camera(std::move(s.camera));
  if (!options.velodyne.empty() || !options.calibration.empty()) {
    const sensors::Hdl64Lasers lasers = lasers_of(recording);
    if (!options.calibration.empty())
      sensors::write_velodyne_calibration(options.calibration, lasers);
    if (!options.velodyne.empty()) sending.add_velodyne(std::move(s.velodyne), lasers);
  }
  sending.add_lines("imu", options.imu, send_imu, std::move(s.imu));
  sending.add_lines("gnss", options.gnss, send_gnss, std::move(s.gnss));
  if (sending.empty()) {
    if (!options.calibration.empty()) return 0;
    throw std::runtime_error("nothing to send: give --camera, --velodyne, --imu or --gnss");
  }
  note_interrupts();
  const Duration shift = sending.run();
  if (!options.truth.empty()) write_truth(options.truth, recording, shift);
  sending.print();
  return 0;
}

}  // namespace maploop::tools
