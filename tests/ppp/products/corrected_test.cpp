// Tests corrections that are made from precise products, sent as messages, and applied to broadcast
// orbits: the result is nearly as good as these products.
#include "ppp/products/corrected.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "msgs/frames.h"
#include "ppp/gnss_files.h"
#include "ppp/ppp_setup.h"
#include "ppp/readers/corrections/correction_stream.h"
#include "tests/ppp/products/caster.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"
#include "tools/ppp/score.h"

namespace maploop::ppp {
namespace {

using gnss::Accuracy;
using maploop::testing::SsrForm;
using std::chrono::seconds;

std::span<const std::uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void feed(CorrectedEphemeris& ephemeris, CorrectionStream& stream, const std::string& bytes) {
  EXPECT_TRUE(stream.push(as_bytes(bytes)));
  for (const SsrUpdate& u : stream.updates()) ephemeris.add(u);
  stream.updates().clear();
  if (stream.ionosphere()) ephemeris.add(*std::exchange(stream.ionosphere(), std::nullopt));
}

// Only Galileo is used. The clocks of the products are 5 minutes apart, and between them GPS's are
// wrong by centimetres. The filter with these products models that error; one with corrections made
// from them cannot.
SetupOptions options() {
  SetupOptions o;
  o.parameters.systems = "E";
  return o;
}

// Drives with corrections every 5 s, 3 s late, for `until` s, and scores after `skip_seconds`.
Accuracy corrected_drive(SsrForm form, double until, double skip_seconds) {
  const PppSetup setup(kamakura(), options());
  CorrectedEphemeris ephemeris{BroadcastEphemeris(kamakura().navigation)};
  PppFilter filter = setup.make_filter(&ephemeris);
  const auto& epochs = setup.observations().epochs;
  const GpsTime first = epochs.front().time;
  CorrectionStream stream(first);
  const gnss::Truth truth((kamakura_folder() / "rtk_reference.pos.gz").string(), first);
  gnss::Score score(truth, 1e-4);
  for (const Epoch& epoch : epochs) {
    const GpsTime sent = epoch.time - seconds(3);
    if (std::lround(seconds_of_week(sent)) % 5 == 0 && to_seconds(epoch.time - first) < until) {
      feed(ephemeris, stream, caster().messages(form, sent));
    }
    ephemeris.begin(epoch.time);
    score.add(filter.process(epoch));
  }
  EXPECT_EQ(stream.counts().unusable + stream.counts().damaged, 0u);
  return score.accuracy(first + from_seconds(skip_seconds));
}

Accuracy drive_with(bool broadcast) {
  SetupOptions o = options();
  o.broadcast = broadcast;
  const PppSetup setup(kamakura(), o);
  PppFilter filter = setup.make_filter();
  const GpsTime first = setup.observations().epochs.front().time;
  const gnss::Truth truth((kamakura_folder() / "rtk_reference.pos.gz").string(), first);
  gnss::Score score(truth, 1e-4);
  for (const Epoch& epoch : setup.observations().epochs) score.add(filter.process(epoch));
  return score.accuracy(first + seconds(120));
}

TEST(CorrectedEphemeris, GivesTheOrbitsAndClocksThatCorrectionsWereMadeFrom) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GpsTime epoch = kamakura().observations[0].epochs.front().time;
  for (const SsrForm form : {SsrForm::rtcm, SsrForm::igs}) {
    CorrectedEphemeris ephemeris{BroadcastEphemeris(kamakura().navigation)};
    CorrectionStream stream(epoch);
    feed(ephemeris, stream, caster().messages(form, epoch));
    const GpsTime t = epoch + seconds(4);
    ephemeris.begin(t);
    int compared = 0;
    for (const System system : {System::gps, System::galileo}) {
      for (std::uint8_t n = 1; n <= 36; ++n) {
        const Satellite satellite{system, n};
        if (!ephemeris.corrected(satellite)) continue;
        const auto found = ephemeris.at(satellite, t);
        const auto expected = caster().precise().at(satellite, t);
        ASSERT_TRUE(found && expected);
        EXPECT_LT(
            (found->position - caster().phase_centre(satellite, expected->position, t)).norm(),
            2e-3)
            << to_string(satellite);
        EXPECT_NEAR(speed_of_light * found->clock, speed_of_light * expected->clock, 1e-3);
        const double bias = caster().precise().code_bias(satellite, '1', 'C', t);
        if (bias != 0.0) {
          EXPECT_NEAR(ephemeris.code_bias(satellite, '1', 'C', t), bias, 0.006);
        }
        EXPECT_LT(found->sigma, 0.1);
        ++compared;
      }
    }
    EXPECT_GT(compared, 15);
    EXPECT_EQ(*ephemeris.age(), t - epoch - std::chrono::milliseconds(2500));
  }
}

TEST(CorrectedEphemeris, ACarIsFollowedNearlyAsWithPreciseProducts) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Accuracy precise = drive_with(false), broadcast = drive_with(true);
  for (const SsrForm form : {SsrForm::rtcm, SsrForm::igs}) {
    const Accuracy corrected = corrected_drive(form, 1e9, 120.0);
    EXPECT_EQ(corrected.solved, corrected.with_truth);
    EXPECT_NEAR(corrected.horizontal_rmse, precise.horizontal_rmse, 0.05);
    // The truth's base is 0.3 m off, so that the mean with precise products is the better truth.
    const auto off = [&](const Accuracy& accuracy) {
      return (accuracy.mean_enu - precise.mean_enu).head<2>().norm();
    };
    EXPECT_LT(off(corrected), 0.1 * off(broadcast));
  }
}

TEST(CorrectedEphemeris, WithoutNewCorrectionsItIsAsBroadcast) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GpsTime epoch = kamakura().observations[0].epochs.front().time;
  const BroadcastEphemeris broadcast(kamakura().navigation);
  CorrectedEphemeris ephemeris{broadcast};
  CorrectionStream stream(epoch);
  Satellite satellite;
  for (const SatelliteSignals& s : kamakura().observations[0].epochs.front().satellites) {
    if (s.satellite.system == System::gps && caster().update(s.satellite, epoch)) {
      satellite = s.satellite;
    }
  }
  ephemeris.begin(epoch);
  EXPECT_FALSE(ephemeris.age());
  EXPECT_FALSE(ephemeris.corrected(satellite));
  feed(ephemeris, stream, caster().messages(SsrForm::rtcm, epoch));
  ephemeris.begin(epoch + seconds(60));
  EXPECT_TRUE(ephemeris.corrected(satellite));
  EXPECT_NE(ephemeris.at(satellite, epoch)->source, 0u);
  ephemeris.begin(epoch + seconds(120));
  EXPECT_FALSE(ephemeris.corrected(satellite));
  EXPECT_GT(*ephemeris.age(), CorrectedEphemeris::longest_age);
  EXPECT_EQ(ephemeris.at(satellite, epoch)->position, broadcast.at(satellite, epoch)->position);
  EXPECT_EQ(ephemeris.at(satellite, epoch)->source, 0u);
  // The filter continues without corrections.
  const Accuracy a = corrected_drive(SsrForm::rtcm, 150.0, 250.0);
  EXPECT_EQ(a.solved, a.with_truth);
  EXPECT_LT(a.horizontal_rmse, 3.0);
}

TEST(Ssr, RefusesWhatIsCutAndPassesOverWhatIsNotUsed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GpsTime epoch = kamakura().observations[0].epochs.front().time;
  const std::string sound = caster().messages(SsrForm::igs, epoch);
  Rtcm3Message message;
  ASSERT_TRUE(Rtcm3Frames(sound).next(message));
  std::vector<SsrUpdate> updates;
  std::optional<SsrIonosphere> ionosphere;
  EXPECT_EQ(decode_ssr(message, epoch, updates, ionosphere), SsrResult::decoded);
  const std::size_t count = updates.size();
  EXPECT_GT(count, 5u);
  for (std::size_t size = 2; size + 2 < message.payload.size(); size += 7) {
    const Rtcm3Message cut{message.number, message.payload.substr(0, size), 0};
    EXPECT_NE(decode_ssr(cut, epoch, updates, ionosphere), SsrResult::decoded);
    EXPECT_EQ(updates.size(), count);
  }
  const std::string zeros(30, '\0');
  EXPECT_EQ(decode_ssr({1258, zeros, 0}, epoch, updates, ionosphere), SsrResult::unsupported);
  EXPECT_EQ(decode_ssr({1019, zeros, 0}, epoch, updates, ionosphere), SsrResult::none);
}

TEST(Ssr, PhaseBiasesAreThoseOfTheProductsAndMakeIntegers) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GpsTime epoch = kamakura().observations[0].epochs.front().time;
  for (const SsrForm form : {SsrForm::rtcm, SsrForm::igs}) {
    CorrectedEphemeris ephemeris{BroadcastEphemeris(kamakura().navigation)};
    CorrectionStream stream(epoch);
    feed(ephemeris, stream, caster().messages(form, epoch) + caster().phase_biases(form, epoch, 2));
    const GpsTime t = epoch + seconds(4);
    ephemeris.begin(t);
    int compared = 0;
    for (std::uint8_t n = 1; n <= 36; ++n) {
      const Satellite satellite{System::galileo, n};
      const auto expected = caster().precise().phase_bias(satellite, '5', 'Q', t);
      if (!expected || *expected == 0.0 || !ephemeris.corrected(satellite)) continue;
      const auto found = ephemeris.phase_bias(satellite, '5', 'Q', t);
      ASSERT_TRUE(found) << to_string(satellite);
      EXPECT_NEAR(*found, *expected, 1e-4);
      EXPECT_FALSE(ephemeris.phase_bias(satellite, '7', 'Q', t));
      EXPECT_EQ(ephemeris.at(satellite, t)->phase_jumps, 4U) << "two signals, twice each";
      ++compared;
    }
    EXPECT_GT(compared, 5);
    EXPECT_EQ(stream.counts().unsupported, 0U);
  }
}

TEST(Ssr, AmbiguitiesRestartWhenPhaseBiasesJump) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const PppSetup setup(kamakura(), options());
  CorrectedEphemeris ephemeris{BroadcastEphemeris(kamakura().navigation)};
  PppFilter filter = setup.make_filter(&ephemeris);
  const auto& epochs = setup.observations().epochs;
  CorrectionStream stream(epochs.front().time);
  std::vector<int> candidates;
  std::vector<double> variance;
  for (std::size_t i = 0; i < 260; ++i) {
    if (i % 5 == 0) {
      const GpsTime sent = epochs[i].time;
      feed(ephemeris, stream,
           caster().messages(SsrForm::igs, sent) +
               caster().phase_biases(SsrForm::igs, sent, i < 250 ? 0 : 1));
    }
    ephemeris.begin(epochs[i].time);
    const PppSolution& solution = filter.process(epochs[i]);
    candidates.push_back(solution.integers.candidates);
    variance.push_back(solution.covariance.trace());
  }
  EXPECT_GT(candidates[249], 3) << "the biases of the stream leave integers";
  EXPECT_LT(variance[249], 1.01 * variance[248]);
  EXPECT_GT(variance[250], 1.1 * variance[249]) << "the biases have jumped";
}

TEST(Ssr, ElectronsOfTheIonosphere) {
  const GpsTime epoch = gps_time({2021, 9, 22, 6, 30, 0.0});
  // 20 TECU, 4 more towards the pole by the normalized harmonic of degree 1, and a bulge that
  // follows the sun.
  const SsrLayer layer{
      1, 1, {20.0, 4.0 / std::sqrt(3.0), 10.0 / std::sqrt(3.0)}, {-1.0 / std::sqrt(3.0)}};
  for (const SsrForm form : {SsrForm::rtcm, SsrForm::igs}) {
    CorrectedEphemeris ephemeris{BroadcastEphemeris(std::vector<NavigationFile>{})};
    CorrectionStream stream(epoch);
    feed(ephemeris, stream, maploop::testing::ssr_ionosphere(form, epoch, layer));
    for (const double hours : {0.0, 0.1}) {
      const GpsTime t = epoch + from_seconds(3600.0 * hours);
      for (const double longitude : {-100.0, 0.0, 139.0}) {
        const double latitude = radians(35.0);
        const auto electrons = ephemeris.electrons().at({latitude, radians(longitude)}, t);
        ASSERT_TRUE(electrons);
        const double sun = radians(longitude + 15.0 * (6.5 + hours - 14.0));
        EXPECT_NEAR(electrons->value,
                    20.0 + 4.0 * std::sin(latitude) +
                        std::cos(latitude) * (10.0 * std::cos(sun) - std::sin(sun)),
                    0.02);
        EXPECT_DOUBLE_EQ(electrons->sigma, 2.0);
      }
    }
    EXPECT_FALSE(ephemeris.electrons().at({}, epoch + std::chrono::minutes(11))) << "too old";
  }
}

}  // namespace
}  // namespace maploop::ppp
