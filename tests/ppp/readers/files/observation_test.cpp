// Tests observation files: compact forms against their plain versions, and real files of receivers.
#include "ppp/readers/files/observation.h"

#include <gtest/gtest.h>

#include "ppp/readers/files/lines.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

std::filesystem::path gnss(const std::string& name) {
  return maploop::testing::real_data() / "gnss" / name;
}

Observations read(const std::string& name) {
  return parse_observations(read_file(gnss(name)), name);
}

const Signal* find(const Epoch& epoch, Satellite satellite, char band, char attribute) {
  for (const auto& s : epoch.satellites) {
    if (s.satellite != satellite) continue;
    for (const Signal& signal : epoch.of(s)) {
      if (signal.band == band && signal.attribute == attribute) return &signal;
    }
  }
  return nullptr;
}

void expect_same(const Observations& a, const Observations& b) {
  ASSERT_EQ(a.epochs.size(), b.epochs.size());
  ASSERT_GT(a.epochs.size(), 10U);
  for (std::size_t i = 0; i < a.epochs.size(); ++i) {
    const Epoch &x = a.epochs[i], &y = b.epochs[i];
    ASSERT_EQ(x.time, y.time);
    ASSERT_EQ(x.clock_offset, y.clock_offset);
    ASSERT_EQ(x.satellites.size(), y.satellites.size()) << format_gps_time(x.time);
    ASSERT_EQ(x.signals.size(), y.signals.size());
    for (std::size_t k = 0; k < x.satellites.size(); ++k) {
      ASSERT_EQ(x.satellites[k].satellite, y.satellites[k].satellite);
    }
    for (std::size_t k = 0; k < x.signals.size(); ++k) {
      const Signal &p = x.signals[k], &q = y.signals[k];
      ASSERT_EQ(std::tie(p.band, p.attribute, p.lost_lock, p.half_cycle),
                std::tie(q.band, q.attribute, q.lost_lock, q.half_cycle));
      ASSERT_EQ(std::tie(p.code, p.phase, p.doppler, p.cn0),
                std::tie(q.code, q.phase, q.doppler, q.cn0));
    }
  }
}

TEST(ObservationFile, CompactVersion1IsItsPlainTwin) {
  MAPLOOP_REQUIRE_REAL_DATA();
  expect_same(read("parser_samples/zegv0010.21d"), read("parser_samples/zegv0010.21o"));
  expect_same(read("parser_samples/delf0010.21d"), read("parser_samples/delf0010.21o"));
}

TEST(ObservationFile, ADayOfAStationInCompactVersion3) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Observations o = read("esbc_static/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz");
  EXPECT_EQ(o.epochs.size(), 2880U);
  EXPECT_EQ(o.refused, 0);
  EXPECT_EQ(o.header.antenna, "ASH701945E_M");
  EXPECT_EQ(o.header.radome, "SCIS");
  EXPECT_DOUBLE_EQ(o.header.antenna_delta_enu.z(), 0.2160);
  EXPECT_EQ(format_gps_time(o.epochs.back().time), "2020-06-25 23:59:30.000");
  EXPECT_EQ(o.epochs.front().satellites.size(), 43U);
  const Signal* signal = find(o.epochs.front(), {System::beidou, 5}, '2', 'I');
  ASSERT_NE(signal, nullptr);
  EXPECT_DOUBLE_EQ(signal->code, 40715949.461);
  EXPECT_DOUBLE_EQ(signal->phase, 212018673.071);
  EXPECT_DOUBLE_EQ(signal->doppler, -2.196);
  EXPECT_DOUBLE_EQ(signal->cn0, 34.5);
}

TEST(ObservationFile, ACarAtOneHertz) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Observations o = read("kamakura_kinematic/SEPT265G.21O.gz");
  EXPECT_EQ(o.epochs.size(), 360U);
  EXPECT_EQ(o.epochs.front().satellites.size(), 19U);
  const Signal* signal = find(o.epochs.front(), {System::galileo, 7}, '5', 'Q');
  ASSERT_NE(signal, nullptr);
  EXPECT_DOUBLE_EQ(signal->phase, 95913637.913);
  EXPECT_FALSE(signal->lost_lock);
}

class ChangedCar : public ::testing::Test {
 protected:
  static std::string whole() { return read_file(gnss("kamakura_kinematic/SEPT265G.21O.gz")); }
  void SetUp() override {
    MAPLOOP_REQUIRE_REAL_DATA();
    text_ = whole();
  }

  // Returns the place of an epoch's line, from 0.
  std::size_t epoch(int number) const {
    std::size_t at = 0;
    for (int i = 0; i <= number; ++i) at = text_.find("\n> ", at) + 1;
    return at;
  }
  Observations parsed() const { return parse_observations(text_, "car.21O"); }

  std::string text_;
};

TEST_F(ChangedCar, OneWrongDateCostsOneEpoch) {
  const std::size_t epochs = parsed().epochs.size();
  for (const int wrong : {0, 5, 100}) {
    text_ = whole();
    text_.replace(epoch(wrong), 12, "> 2021 09 23");
    const Observations o = parsed();
    EXPECT_EQ(o.epochs.size(), epochs - 1) << wrong;
    EXPECT_EQ(o.refused, 1) << wrong;
    ASSERT_EQ(o.refusals.size(), 1u);
    EXPECT_NE(o.refusals[0].find("its date is taken to be wrong"), std::string::npos);
  }
}

TEST_F(ChangedCar, AnAntennaThatIsMovedIsSaid) {
  text_.insert(
      epoch(17),
      "> 2021 09 22 06 30 17.0000000  4  1\n"
      "        5.0000        0.0000        0.0000                  ANTENNA: DELTA H/E/N\n");
  const Observations o = parsed();
  EXPECT_EQ(o.header.antenna_delta_enu.z(), 0.0);
  ASSERT_EQ(o.refusals.size(), 1u);
  EXPECT_NE(o.refusals[0].find("split the file"), std::string::npos);
}

TEST(ObservationFile, AnAntennaThatIsMovedIsSaidInTheCompactForm) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::string text = read_file(gnss("parser_samples/KUNZ00CZE.crx"));
  const Observations as_it_is = parse_observations(text, "KUNZ00CZE.crx");
  text.insert(text.find('\n', text.find("END OF HEADER")) + 1,
              ">                              4  1\n"
              "        5.0000        0.0000        0.0000                  ANTENNA: DELTA H/E/N\n");
  const Observations o = parse_observations(text, "KUNZ00CZE.crx");
  EXPECT_EQ(o.epochs.size(), as_it_is.epochs.size());
  EXPECT_EQ(o.header.antenna_delta_enu, as_it_is.header.antenna_delta_enu);
  ASSERT_EQ(o.refused, as_it_is.refused + 1);
  EXPECT_NE(o.refusals[0].find("split the file"), std::string::npos);
}

TEST(ObservationFile, EveryRealSampleIsRead) {
  MAPLOOP_REQUIRE_REAL_DATA();
  EXPECT_GT(read("parser_samples/KUNZ00CZE.crx").epochs.size(), 1U);
  EXPECT_EQ(read("parser_samples/GRAS00FRA_R_20223151700_15M_01S_MO.crx.gz").epochs.size(), 900U);
  EXPECT_EQ(read("riverside_drive/COM3_200712.obs.gz").epochs.size(), 3810U);
  EXPECT_EQ(read("kamakura_kinematic/3034265G.21O.gz").epochs.size(), 360U);
}

TEST(ObservationFile, ACutLastEpochIsRefusedAndTheRestKept) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const std::string name : {"zegv0010.21o", "zegv0010.21d"}) {
    const std::string text = read_file(gnss("parser_samples/" + name));
    const auto whole = parse_observations(text, name).epochs.size();
    const Observations cut = parse_observations(text.substr(0, text.size() - 300), name);
    EXPECT_EQ(cut.epochs.size(), whole - 1);
    EXPECT_EQ(cut.refused, 1);
    EXPECT_NE(cut.refusals.at(0).find(name + ":"), std::string::npos);
  }
}

}  // namespace
}  // namespace maploop::ppp
