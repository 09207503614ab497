#include "msgs/lcm/conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "msgs/archive.h"

namespace maploop {
namespace {

// Encodes a message to bytes and decodes it again.
template <class Lcm>
Lcm over_the_wire(const Lcm& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  EXPECT_EQ(message.encode(bytes.data(), 0, size), size);
  Lcm received;
  EXPECT_EQ(received.decode(bytes.data(), 0, size), size);
  return received;
}

template <class T>
T round_trip(const T& value) {
  return from_lcm(over_the_wire(to_lcm(value)));
}

void fill(Sample& sample) {
  sample.stamp = from_nanoseconds(1'317'042'651'174'740'992);
  sample.available = from_nanoseconds(1'317'042'651'229'740'993);
  sample.sequence = 4711;
}

void expect_same_times(const Sample& a, const Sample& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.available, b.available);
  EXPECT_EQ(a.sequence, b.sequence);
}

TEST(LcmConversions, NavState) {
  NavState s;
  fill(s);
  s.status = NavStatus::coasting;
  s.origin = {0.855, 0.147, 114.1};
  s.position_enu = {1.0 / 3.0, -2.0, 3.0};
  s.velocity_enu = {4.0, -5.0, 6.0};
  s.attitude = {1.1, 0.01, -0.02};
  s.forward_speed = 12.3;
  s.gyro_bias = 1e-5;
  s.covariance.setRandom();
  s.imu_stamp = from_nanoseconds(1);
  s.odometry_stamp = from_nanoseconds(2);
  s.gnss_stamp = from_nanoseconds(3);
  s.wheel_stamp = from_nanoseconds(4);
  s.zero_velocity_stamp = from_nanoseconds(7);
  s.reinitializations = 8;
  s.odometry_applied = 5;
  s.odometry_refused = 6;

  const NavState r = round_trip(s);
  expect_same_times(r, s);
  EXPECT_EQ(r.status, s.status);
  EXPECT_EQ(r.origin.latitude, s.origin.latitude);
  EXPECT_EQ(r.origin.longitude, s.origin.longitude);
  EXPECT_EQ(r.origin.height, s.origin.height);
  EXPECT_EQ(r.position_enu, s.position_enu);
  EXPECT_EQ(r.velocity_enu, s.velocity_enu);
  EXPECT_EQ(r.attitude.azimuth, s.attitude.azimuth);
  EXPECT_EQ(r.attitude.pitch, s.attitude.pitch);
  EXPECT_EQ(r.attitude.roll, s.attitude.roll);
  EXPECT_EQ(r.forward_speed, s.forward_speed);
  EXPECT_EQ(r.gyro_bias, s.gyro_bias);
  EXPECT_EQ(r.covariance, s.covariance);
  EXPECT_EQ(r.imu_stamp, s.imu_stamp);
  EXPECT_EQ(r.wheel_stamp, s.wheel_stamp);
  EXPECT_EQ(r.zero_velocity_stamp, s.zero_velocity_stamp);
  EXPECT_EQ(r.reinitializations, s.reinitializations);
  EXPECT_EQ(r.odometry_stamp, s.odometry_stamp);
  EXPECT_EQ(r.gnss_stamp, s.gnss_stamp);
  EXPECT_EQ(r.odometry_applied, s.odometry_applied);
  EXPECT_EQ(r.odometry_refused, s.odometry_refused);
}

TEST(LcmConversions, LidarMotion) {
  LidarMotion m;
  fill(m);
  m.status = OdometryStatus::disagreement;
  m.source = OdometrySource::visual_lidar;
  m.from = from_nanoseconds(42);
  m.tracked = 5400;
  m.degenerate = maploop_lcm::lidar_motion_t::ALONG | maploop_lcm::lidar_motion_t::YAW;
  m.iterations = 4;
  m.seed_translation_error = 0.6;
  m.seed_rotation_error = 0.02;

  const LidarMotion r = round_trip(m);
  expect_same_times(r, m);
  EXPECT_EQ(r.status, m.status);
  EXPECT_EQ(r.source, m.source);
  EXPECT_EQ(r.from, m.from);
  EXPECT_EQ(r.tracked, m.tracked);
  EXPECT_EQ(r.degenerate, m.degenerate);
  EXPECT_EQ(r.degenerate, 1u << static_cast<int>(MotionDirection::along) |
                              1u << static_cast<int>(MotionDirection::yaw));
  EXPECT_EQ(r.iterations, m.iterations);
  EXPECT_EQ(r.seed_translation_error, m.seed_translation_error);
  EXPECT_EQ(r.seed_rotation_error, m.seed_rotation_error);
}

TEST(LcmConversions, MapMatch) {
  MapMatch match;
  fill(match);
  match.phase = MatchPhase::at_junction;
  match.on_road = true;
  match.link = {77, false};
  match.along = 12.5;
  match.sigma_along = 3.0;
  match.sigma_across = 4.0;
  match.likelihood = 81.0;
  match.probability = 0.97;
  match.margin = 0.9;
  match.off_road = 0.01;
  match.way_id = 10;
  match.node_a = 1;
  match.node_b = 2;
  match.origin = {0.85, 0.14, 110.0};
  match.vehicle_enu = {3.0, 4.0};
  match.covariance << 2.0, 0.5, 0.5, 3.0;
  match.vehicle_azimuth = 0.1;
  match.speed = 9.0;
  match.matched_enu = {5.0, 6.0};
  match.link_azimuth = 0.2;
  match.cross_track = -1.5;
  match.half_width = 2.75;
  match.bend = -0.3;
  match.to_junction = 30.0;
  match.candidate_count = 2;
  match.candidates[1].link = {5, true};
  match.candidates[1].way_id = 11;
  match.candidates[1].node_a = 3;
  match.candidates[1].node_b = 4;
  match.candidates[1].along = 7.0;
  match.candidates[1].distance = 8.0;
  match.candidates[1].azimuth_error = 0.7;
  match.candidates[1].connectivity = 1.0;
  match.candidates[1].rules = RuleBase::junction;
  match.candidates[1].decided = true;
  match.candidates[1].likelihood = 33.0;
  match.candidates[1].probability = 0.02;
  match.candidates[1].weights[31] = 0.25F;
  const MapMatchWords words{"way 10", {{"way 10", {}, {}}, {"way 11", {"8 m away"}, {"0.25: if"}}}};

  const auto message = to_lcm(match, words);
  EXPECT_EQ(message.explanation, "way 10");
  EXPECT_EQ(message.candidates[1].road, "way 11");
  EXPECT_EQ(message.candidates[1].objections, std::vector<std::string>{"8 m away"});
  EXPECT_EQ(message.candidates[1].rules, std::vector<std::string>{"0.25: if"});
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  ASSERT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  maploop_lcm::map_match_t received;
  ASSERT_EQ(received.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  const MapMatch r = from_lcm(received);
  expect_same_times(r, match);
  EXPECT_EQ(r.phase, match.phase);
  EXPECT_EQ(r.refusal, match.refusal);
  EXPECT_EQ(r.on_road, match.on_road);
  EXPECT_EQ(r.link, match.link);
  EXPECT_EQ(std::tie(r.along, r.sigma_along, r.sigma_across, r.likelihood, r.probability, r.margin,
                     r.off_road, r.way_id, r.node_a, r.node_b),
            std::tie(match.along, match.sigma_along, match.sigma_across, match.likelihood,
                     match.probability, match.margin, match.off_road, match.way_id, match.node_a,
                     match.node_b));
  EXPECT_EQ(std::tie(r.origin.latitude, r.origin.longitude, r.origin.height, r.vehicle_azimuth,
                     r.speed, r.link_azimuth, r.cross_track, r.half_width, r.bend, r.to_junction),
            std::tie(match.origin.latitude, match.origin.longitude, match.origin.height,
                     match.vehicle_azimuth, match.speed, match.link_azimuth, match.cross_track,
                     match.half_width, match.bend, match.to_junction));
  EXPECT_EQ(r.vehicle_enu, match.vehicle_enu);
  EXPECT_EQ(r.covariance, match.covariance);
  EXPECT_EQ(r.matched_enu, match.matched_enu);
  ASSERT_EQ(r.candidate_count, 2U);
  const MatchCandidate& a = r.candidates[1];
  const MatchCandidate& b = match.candidates[1];
  EXPECT_EQ(a.link, b.link);
  EXPECT_EQ(std::tie(a.way_id, a.node_a, a.node_b, a.along, a.distance, a.azimuth_error,
                     a.connectivity, a.rules, a.decided, a.likelihood, a.probability, a.weights),
            std::tie(b.way_id, b.node_a, b.node_b, b.along, b.distance, b.azimuth_error,
                     b.connectivity, b.rules, b.decided, b.likelihood, b.probability, b.weights));
  EXPECT_TRUE(std::isnan(a.distance_error)) << "not known";
}

TEST(LcmConversions, AMatchWithMoreCandidatesThanItHoldsIsRefused) {
  auto message = to_lcm(MapMatch{}, {});
  message.candidates.resize(LinkMatch::max_candidates + 1);
  EXPECT_THROW(from_lcm(message), std::invalid_argument);
  message.candidates.clear();
  message.phase = 9;
  EXPECT_THROW(from_lcm(message), std::invalid_argument);
}

TEST(LcmConversions, RelativeMotion) {
  RelativeMotion m;
  fill(m);
  m.status = OdometryStatus::too_few_inliers;
  m.from = from_nanoseconds(42);
  m.translation = {1.2, 0.1, -0.01};
  m.rotation = Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized();
  m.covariance.setRandom();
  m.tracked = 300;
  m.inliers = 250;

  const RelativeMotion r = round_trip(m);
  expect_same_times(r, m);
  EXPECT_EQ(r.status, m.status);
  EXPECT_EQ(r.from, m.from);
  EXPECT_EQ(r.translation, m.translation);
  EXPECT_EQ(r.rotation.coeffs(), m.rotation.coeffs());
  EXPECT_EQ(r.covariance, m.covariance);
  EXPECT_EQ(r.tracked, m.tracked);
  EXPECT_EQ(r.inliers, m.inliers);
}

TEST(LcmConversions, ImuSample) {
  ImuSample s;
  fill(s);
  s.specific_force_forward = 0.3;
  s.specific_force_left = -0.4;
  s.yaw_rate = 0.05;
  const ImuSample r = round_trip(s);
  expect_same_times(r, s);
  EXPECT_EQ(r.specific_force_forward, s.specific_force_forward);
  EXPECT_EQ(r.specific_force_left, s.specific_force_left);
  EXPECT_EQ(r.yaw_rate, s.yaw_rate);
}

TEST(LcmConversions, WheelSpeed) {
  WheelSpeed w;
  fill(w);
  w.speed = -3.25;
  w.sigma = 0.05;
  const WheelSpeed r = round_trip(w);
  expect_same_times(r, w);
  EXPECT_EQ(r.speed, w.speed);
  EXPECT_EQ(r.sigma, w.sigma);
}

TEST(LcmConversions, GnssFix) {
  GnssFix f;
  fill(f);
  f.position = {0.855, 0.147, 114.1};
  f.position_covariance.setRandom();
  f.velocity_stamp = from_nanoseconds(77);
  f.velocity_enu = {1.0, 2.0, 3.0};
  f.velocity_covariance.setRandom();
  const GnssFix r = round_trip(f);
  expect_same_times(r, f);
  EXPECT_EQ(r.position.latitude, f.position.latitude);
  EXPECT_EQ(r.position.longitude, f.position.longitude);
  EXPECT_EQ(r.position.height, f.position.height);
  EXPECT_EQ(r.position_covariance, f.position_covariance);
  EXPECT_EQ(r.velocity_stamp, f.velocity_stamp);
  EXPECT_EQ(r.velocity_enu, f.velocity_enu);
  EXPECT_EQ(r.velocity_covariance, f.velocity_covariance);
}

TEST(LcmConversions, Preview) {
  Preview p;
  fill(p);
  p.width = 3;
  p.height = 2;
  p.jpeg = {0xff, 0xd8, 0x00};
  p.tracks = {{1.0F, 2.0F, 3.0F, 4.0F}, {5.0F, 6.0F, 7.0F, 8.0F}};
  p.scan_stamp = from_nanoseconds(77);
  p.points = {{-32767, 0, 32767}};
  const Preview r = round_trip(p);
  EXPECT_EQ(r.width, 3);
  EXPECT_EQ(r.height, 2);
  EXPECT_EQ(r.jpeg, p.jpeg);
  ASSERT_EQ(r.tracks.size(), 2u);
  EXPECT_EQ(r.tracks[1].from_u, 5.0F);
  EXPECT_EQ(r.tracks[1].from_v, 6.0F);
  EXPECT_EQ(r.tracks[1].u, 7.0F);
  EXPECT_EQ(r.tracks[1].v, 8.0F);
  EXPECT_EQ(r.scan_stamp, p.scan_stamp);
  ASSERT_EQ(r.points.size(), 1u);
  EXPECT_EQ(r.points[0].x, -32767);
  EXPECT_EQ(r.points[0].z, 32767);
  EXPECT_EQ(round_trip(Preview{}).points.size(), 0u);
}

TEST(LcmConversions, PppState) {
  PppState s;
  fill(s);
  s.status = PppStatus::converged;
  s.message = "started again";
  s.position = {0.62, 2.44, 51.0};
  s.position_covariance.setRandom();
  s.velocity_enu = {1.0, -2.0, 0.5};
  s.velocity_covariance.setRandom();
  s.protection = {0.1, 0.2, 0.3};
  s.integrity_risk = 1e-5;
  s.zenith_delay = 2.41;
  s.zenith_delay_sigma = 0.02;
  s.code_rms = 0.7;
  s.phase_rms = 0.008;
  s.converging_for = 123.0;
  s.satellites_corrected = 7;
  s.correction_age = 4.5;
  s.restarts = 2;
  s.map = PppMap::paused;
  s.roads_used = 12;
  s.roads_refused = 34;
  s.satellites_used = 9;
  s.satellites = {
      {'E', 33, 1.0F, 0.5F, 44.0F, true, false, 0.7F, 0.01F, PppRefusal::phase_misfit,
       PppSlip::wide_lane},
      {'G', 5, 0.0F, 0.0F, 0.0F, false, false, 0.0F, 0.0F, PppRefusal::too_many, PppSlip::doppler}};
  const PppState r = round_trip(s);
  expect_same_times(r, s);
  ArchiveWriter sent, received;  // every field, bit for bit
  sent(s);
  received(r);
  EXPECT_EQ(received.content(), sent.content());
  maploop_lcm::ppp_state_t m = to_lcm(s);
  m.map = 3;
  EXPECT_THROW(from_lcm(m), std::invalid_argument);
  m.map = 0;
  m.satellites[0].refusal = 11;
  EXPECT_THROW(from_lcm(m), std::invalid_argument);
  m.satellites[0] = to_lcm(s).satellites[0];
  m.satellites[0].name = "E3";
  EXPECT_THROW(from_lcm(m), std::invalid_argument);
}

TEST(LcmConversions, ReferencePose) {
  ReferencePose p;
  fill(p);
  p.position = {0.855, 0.147, 114.1};
  p.attitude = {2.0, 0.03, -0.04};
  p.velocity_stamp = from_nanoseconds(77);
  p.velocity_enu = {1.0, 2.0, 3.0};
  p.position_accuracy = 0.15;
  const ReferencePose r = round_trip(p);
  expect_same_times(r, p);
  EXPECT_EQ(r.position.latitude, p.position.latitude);
  EXPECT_EQ(r.attitude.azimuth, p.attitude.azimuth);
  EXPECT_EQ(r.attitude.pitch, p.attitude.pitch);
  EXPECT_EQ(r.attitude.roll, p.attitude.roll);
  EXPECT_EQ(r.velocity_stamp, p.velocity_stamp);
  EXPECT_EQ(r.velocity_enu, p.velocity_enu);
  EXPECT_EQ(r.position_accuracy, p.position_accuracy);
}

TEST(LcmConversions, Deadlines) {
  Deadlines d;
  d.stamp = Time(std::chrono::microseconds(1'317'042'651'174'740));
  LatencySummary s;
  s.name = "stereo";
  s.count = 144;
  s.misses = 1;
  s.deadline = std::chrono::milliseconds(50);
  s.p50 = Duration(19'123'456);
  s.max = Duration(51'000'001);
  s.guilty = "running";
  s.histogram = {
      {{Duration(100), 3}, {Duration(256), 1}}, 0, 2, Duration(101), Duration(1LL << 40)};
  s.omitted = {{{Duration(0), 7}}, 7, 0, Duration(-5), Duration(-1)};
  s.worst = {
      {from_nanoseconds(5), Duration(6), {{"woken late", Duration(4)}, {"running", Duration(2)}}},
      {from_nanoseconds(7), Duration(5), {}}};
  d.threads = {s};
  d.paths = {s, s};
  d.wake_up = {s};
  d.execution = {s, s, s};
  d.period_jitter = {s};
  const Deadlines r = round_trip(d);
  EXPECT_EQ(r.stamp, d.stamp);
  ASSERT_EQ(r.threads.size(), 1u);
  ASSERT_EQ(r.paths.size(), 2u);
  EXPECT_EQ(r.threads[0].name, s.name);
  EXPECT_EQ(r.threads[0].count, s.count);
  EXPECT_EQ(r.threads[0].misses, s.misses);
  EXPECT_EQ(r.threads[0].deadline, s.deadline);
  EXPECT_EQ(r.threads[0].p50, s.p50);
  EXPECT_EQ(r.threads[0].max, s.max);
  EXPECT_EQ(r.threads[0].guilty, s.guilty);
  EXPECT_EQ(r.wake_up.size(), 1u);
  EXPECT_EQ(r.execution.size(), 3u);
  ASSERT_EQ(r.period_jitter.size(), 1u);
  for (const LatencySummary* t : {&r.threads[0], &r.paths[1], &r.period_jitter[0]}) {
    ASSERT_EQ(t->histogram.buckets.size(), 2u);
    EXPECT_EQ(t->histogram.buckets[1].lowest, Duration(256));
    EXPECT_EQ(t->histogram.buckets[0].count, 3u);
    EXPECT_EQ(t->histogram.above_range, 2u);
    EXPECT_EQ(t->histogram.min, Duration(101));
    EXPECT_EQ(t->histogram.max, Duration(1LL << 40));
    EXPECT_EQ(t->omitted.below_range, 7u);
    ASSERT_EQ(t->worst.size(), 2u);
    EXPECT_EQ(t->worst[0].stamp, from_nanoseconds(5));
    EXPECT_EQ(t->worst[0].latency, Duration(6));
    ASSERT_EQ(t->worst[0].parts.size(), 2u);
    EXPECT_EQ(t->worst[0].parts[1].name, "running");
    EXPECT_EQ(t->worst[0].parts[1].lasted, Duration(2));
    EXPECT_TRUE(t->worst[1].parts.empty());
  }
}

TEST(LcmConversions, Health) {
  Health h;
  h.stamp = Time(std::chrono::microseconds(1'317'042'651'174'740));
  h.threads = {{"fusion", "fifo 60", 1480, 100.0, "", 0.25, 3, 4},
               {"camera", "default", 10, 9.7, "no file"}};
  h.elapsed = 15.5;
  h.cpu = 3.75;
  h.rings = {{"camera -> stereo", 10, 8, 1, 1, 4}};
  h.refusals = {{"fusion", "duplicate", 7}};
  h.outputs = {{"LCM", 200, 3}};
  const SensorClock clock{true, from_seconds(-0.25), 1e-6, Duration(1'500'000), 2};
  h.sensors = {{"imu", "udp://:3000", true, 3, 100, 4, "", clock},
               {"gnss", "", false, 0, 0, 0, "not there", {}}};
  h.settings = {{"fusion: scheduling", "fifo 60", "other", Verdict::refused, "no CAP_SYS_NICE",
                 "run as root"}};
  h.degraded = {"camera has ended"};
  const Health r = round_trip(h);
  EXPECT_EQ(r.stamp, h.stamp);
  ASSERT_EQ(r.threads.size(), 2u);
  EXPECT_EQ(r.threads[1].failure, "no file");
  EXPECT_EQ(r.threads[0].scheduling, "fifo 60");
  EXPECT_EQ(r.threads[0].rate, 100.0);
  EXPECT_EQ(r.threads[0].cpu, 0.25);
  EXPECT_EQ(r.threads[0].left_out, 3u);
  EXPECT_EQ(r.threads[0].shed, 4u);
  EXPECT_EQ(r.elapsed, 15.5);
  EXPECT_EQ(r.cpu, 3.75);
  ASSERT_EQ(r.rings.size(), 1u);
  EXPECT_EQ(r.rings[0].pushed, 10u);
  EXPECT_EQ(r.rings[0].popped, 8u);
  EXPECT_EQ(r.rings[0].lost, 1u);
  EXPECT_EQ(r.rings[0].held, 1u);
  EXPECT_EQ(r.rings[0].capacity, 4u);
  ASSERT_EQ(r.refusals.size(), 1u);
  EXPECT_EQ(r.refusals[0].stage, "fusion");
  EXPECT_EQ(r.refusals[0].reason, "duplicate");
  EXPECT_EQ(r.refusals[0].count, 7u);
  ASSERT_EQ(r.outputs.size(), 1u);
  EXPECT_EQ(r.outputs[0].name, "LCM");
  EXPECT_EQ(r.outputs[0].sent, 200u);
  EXPECT_EQ(r.outputs[0].unsent, 3u);
  ASSERT_EQ(r.sensors.size(), 2u);
  EXPECT_EQ(r.sensors[0].name, "imu");
  EXPECT_EQ(r.sensors[0].endpoint, "udp://:3000");
  EXPECT_TRUE(r.sensors[0].connected);
  EXPECT_EQ(r.sensors[0].connections, 3u);
  EXPECT_EQ(r.sensors[0].delivered, 100u);
  EXPECT_EQ(r.sensors[0].refused, 4u);
  EXPECT_TRUE(r.sensors[0].clock.known);
  EXPECT_EQ(r.sensors[0].clock.utc_ahead, clock.utc_ahead);
  EXPECT_EQ(r.sensors[0].clock.drift, clock.drift);
  EXPECT_EQ(r.sensors[0].clock.delay, clock.delay);
  EXPECT_EQ(r.sensors[0].clock.jumps, clock.jumps);
  EXPECT_EQ(r.sensors[1].problem, "not there");
  EXPECT_FALSE(r.sensors[1].clock.utc_ahead);
  ASSERT_EQ(r.settings.size(), 1u);
  EXPECT_EQ(r.settings[0].name, h.settings[0].name);
  EXPECT_EQ(r.settings[0].asked, h.settings[0].asked);
  EXPECT_EQ(r.settings[0].granted, h.settings[0].granted);
  EXPECT_EQ(r.settings[0].verdict, h.settings[0].verdict);
  EXPECT_EQ(r.settings[0].reason, h.settings[0].reason);
  EXPECT_EQ(r.settings[0].remedy, h.settings[0].remedy);
  EXPECT_EQ(r.degraded, h.degraded);
}

TEST(LcmConversions, UtimeIsTheStampInMicroseconds) {
  ImuSample s;
  fill(s);
  EXPECT_EQ(to_lcm(s).header.utime, 1'317'042'651'174'740);
}

TEST(LcmConversions, AStatusOfAnotherVersionIsRefused) {
  auto state = to_lcm(NavState{});
  state.status = 17;
  EXPECT_THROW(from_lcm(state), std::invalid_argument);
  auto motion = to_lcm(RelativeMotion{});
  motion.status = -1;
  EXPECT_THROW(from_lcm(motion), std::invalid_argument);
  Health health;
  health.settings.resize(1);
  auto message = to_lcm(health);
  message.settings[0].verdict = 9;
  EXPECT_THROW(from_lcm(message), std::invalid_argument);
}

// The constants in the .lcm files must equal those of the enumerations.
TEST(LcmConversions, StatusConstantsAgree) {
  EXPECT_EQ(static_cast<int>(NavStatus::coasting), +maploop_lcm::nav_state_t::COASTING);
  EXPECT_EQ(static_cast<int>(NavStatus::aided), +maploop_lcm::nav_state_t::AIDED);
  EXPECT_EQ(static_cast<int>(OdometryStatus::ok), +maploop_lcm::relative_motion_t::OK);
  EXPECT_EQ(static_cast<int>(OdometryStatus::implausible),
            +maploop_lcm::relative_motion_t::IMPLAUSIBLE);
  EXPECT_EQ(static_cast<int>(OdometryStatus::bad_input),
            +maploop_lcm::relative_motion_t::BAD_INPUT);
  EXPECT_EQ(static_cast<int>(MatchPhase::off_road), +maploop_lcm::map_match_t::OFF_ROAD);
  EXPECT_EQ(static_cast<int>(FixRefusal::no_position), +maploop_lcm::map_match_t::NO_POSITION);
  EXPECT_EQ(static_cast<int>(RuleBase::junction), +maploop_lcm::map_candidate_t::JUNCTION);
  EXPECT_EQ(static_cast<int>(Verdict::refused), +maploop_lcm::realtime_setting_t::REFUSED);
  EXPECT_EQ(static_cast<int>(Verdict::unknown), +maploop_lcm::realtime_setting_t::UNKNOWN);
}

}  // namespace
}  // namespace maploop
