// Tests that one bad place in an observation file costs one epoch.
#include "ppp/readers/files/refused_epochs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ppp/readers/files/observation.h"
#include "tests/ppp/readers/files/header_record.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

std::string text_of(const std::string& name) {
  return read_file(maploop::testing::real_data() / "gnss" / name);
}

int line_of(const std::string& text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

// A drive in RINEX 3 of which something is changed.
class DamagedDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_REAL_DATA();
    text_ = text_of("kamakura_kinematic/SEPT265G.21O.gz");
    epochs_ = parsed().epochs.size();
  }

  // Returns the place of an epoch's line, from 0.
  std::size_t epoch(int number) const {
    std::size_t at = 0;
    for (int i = 0; i <= number; ++i) at = text_.find("\n> ", at) + 1;
    return at;
  }
  // Returns the place of a line of an epoch, from 0, which is the epoch's own.
  std::size_t line(int number, int of_epoch) const {
    std::size_t at = epoch(of_epoch);
    for (int i = 0; i < number; ++i) at = text_.find('\n', at) + 1;
    return at;
  }
  Observations parsed() const { return parse_observations(text_, "car.21O"); }

  // The place is that of the line whose error is named.
  void expect_refused(std::size_t place, std::size_t epochs = 1) const {
    const Observations o = parsed();
    EXPECT_EQ(o.epochs.size(), epochs_ - epochs);
    ASSERT_EQ(o.refused, 1);
    const std::string start = "car.21O:" + std::to_string(line_of(text_, place)) + ": ";
    EXPECT_TRUE(o.refusals[0].starts_with(start)) << o.refusals[0] << ", not " << start;
  }
  void expect_whole() const {
    const Observations o = parsed();
    EXPECT_EQ(o.epochs.size(), epochs_);
    EXPECT_EQ(o.refused, 0) << o.refusals[0];
  }

  std::string text_;
  std::size_t epochs_ = 0;
};

TEST_F(DamagedDrive, ANumberOfSatellitesThatIsTooLargeCostsItsEpoch) {
  text_.replace(epoch(5) + 32, 3, "199");
  expect_refused(epoch(6));
}

TEST_F(DamagedDrive, ANumberOfSatellitesThatIsTooSmallCostsItsEpoch) {
  text_.replace(epoch(5) + 32, 3, "  3");
  expect_refused(line(4, 5));
}

TEST_F(DamagedDrive, AnEpochLineThatCannotBeReadCostsItsEpoch) {
  text_.replace(epoch(5) + 2, 4, "1970");
  expect_refused(epoch(5));
}

TEST_F(DamagedDrive, ASatelliteWithoutANumberCostsItsEpoch) {
  text_.replace(line(3, 5), 3, "G 0");
  expect_refused(line(3, 5));
}

TEST_F(DamagedDrive, ABlankLineInAnEpochCostsIt) {
  text_.insert(line(3, 5), "\n");
  expect_refused(line(3, 5));
}

TEST_F(DamagedDrive, ALetterInAValueCostsItsEpoch) {
  text_[line(3, 5) + 8] = 'x';
  expect_refused(line(3, 5));
}

TEST_F(DamagedDrive, ALostEpochLineCostsTheEpochBeforeItToo) {
  const std::size_t place = epoch(6);
  text_.erase(place, line(1, 6) - place);
  expect_refused(place, 2);
}

TEST_F(DamagedDrive, LostBytesCostTheEpochsAroundThem) {
  text_.erase(line(3, 5) + 30, 500);
  const Observations o = parsed();
  EXPECT_GE(o.epochs.size(), epochs_ - 2);
  EXPECT_GE(o.refused, 1) << o.refusals[0];
}

TEST_F(DamagedDrive, AnOverflowCostsItsValue) {
  for (const char* value : {"**************", "           nan", "          -inf"}) {
    text_.replace(line(3, 5) + 3, 14, value);
    expect_refused(line(3, 5), 0);
  }
}

TEST_F(DamagedDrive, ASatelliteWithoutColumnsIsLeftOut) {
  text_.replace(line(3, 5), 1, "I");
  expect_refused(line(3, 5), 0);
}

TEST_F(DamagedDrive, RecordsOfCycleSlipsAreLeftOut) {
  const std::string copy = text_.substr(epoch(5), epoch(6) - epoch(5));
  text_.insert(epoch(5), copy);
  text_[epoch(5) + 31] = '6';
  expect_refused(epoch(5), 0);
}

TEST_F(DamagedDrive, ACommentBetweenEpochsIsPassedOver) {
  text_.insert(epoch(5), std::string(60, 'c') + "COMMENT\n");
  expect_whole();
}

TEST_F(DamagedDrive, BytesOfNoTextAtTheEndArePassedOver) {
  text_ += std::string(5000, '\0') + '\x1a';
  expect_whole();
}

TEST_F(DamagedDrive, TwoFilesMayFollowEachOther) {
  const std::string header = text_.substr(0, epoch(0));
  text_.insert(epoch(100), header);
  expect_whole();
}

TEST_F(DamagedDrive, NothingBehindAHeaderThatCannotBeReadIsTaken) {
  std::string header = text_.substr(0, epoch(0));
  header.replace(header.find("SYS / # / OBS TYPES") - 57, 3, " xx");
  text_.insert(epoch(300), header);
  const Observations o = parsed();
  EXPECT_EQ(o.epochs.size(), 300U);
  EXPECT_EQ(o.refused, 1);
}

TEST_F(DamagedDrive, AFileOfWhichMoreThanHalfCannotBeReadIsAnError) {
  const auto damage = [&](int count) {
    for (int i = 0; i < count; ++i) text_[line(3, i) + 8] = 'x';
  };
  damage(150);
  EXPECT_EQ(parsed().epochs.size(), epochs_ - 150);
  EXPECT_EQ(parsed().refused, 150);
  damage(250);
  try {
    parsed();
    FAIL();
  } catch (const ReadError& error) {
    const std::string start = "car.21O:" + std::to_string(line_of(text_, line(3, 0))) + ": ";
    EXPECT_TRUE(std::string(error.what()).starts_with(start)) << error.what();
  }
}

TEST(RefusedEpochs, InRinex2ReadingGoesOnAtTheNextEpochLine) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string whole = text_of("parser_samples/zegv0010.21o");
  const std::size_t epochs = parse_observations(whole, "station.obs").epochs.size();
  const std::size_t value = whole.find("24178026.635", whole.find("END OF HEADER"));
  const std::size_t first = whole.find("\n 21 01 01 ", whole.find("END OF HEADER")) + 1;
  for (const auto& [place, text, line] :
       {std::tuple{value, "x", value}, std::tuple{first + 29, " 99", first},
        std::tuple{first + 32, "G 0", first}}) {
    std::string damaged = whole;
    damaged.replace(place, std::string(text).size(), text);
    const Observations o = parse_observations(damaged, "station.obs");
    EXPECT_EQ(o.epochs.size(), epochs - 1) << text;
    ASSERT_EQ(o.refused, 1) << text;
    EXPECT_TRUE(o.refusals[0].starts_with("station.obs:")) << o.refusals[0];
  }
}

// Compact RINEX 3 of one satellite, whose third epoch is complete again.
std::string compact_file() {
  return maploop::testing::header_record("3.0                 COMPACT RINEX FORMAT",
                                         "CRINEX VERS   / TYPE") +
         maploop::testing::header_record("by hand", "CRINEX PROG / DATE") +
         maploop::testing::header_record("     3.04           OBSERVATION DATA    G",
                                         "RINEX VERSION / TYPE") +
         maploop::testing::header_record("G    1 C1C", "SYS / # / OBS TYPES") +
         maploop::testing::header_record("", "END OF HEADER") +
         "> 2021 01 01 00 00  0.0000000  0  1      G05\n\n3&20000000000\n" +
         "                    1\n\n1000\n" +
         "> 2021 01 01 00 00  2.0000000  0  1      G05\n\n3&20000002000\n" +
         "                    3\n\n1000\n";
}

TEST(RefusedEpochs, InCompactRinexReadingGoesOnAtTheNextCompleteEpoch) {
  std::string text = compact_file();
  ASSERT_EQ(parse_observations(text, "c.crx").epochs.size(), 4U);
  text[text.find("\n1000") + 1] = 'x';
  const Observations o = parse_observations(text, "c.crx");
  ASSERT_EQ(o.epochs.size(), 3U);
  EXPECT_DOUBLE_EQ(o.epochs[1].signals.at(0).code, 20000002.0);
  EXPECT_DOUBLE_EQ(o.epochs[2].signals.at(0).code, 20000003.0);
  ASSERT_EQ(o.refused, 1);
  EXPECT_NE(o.refusals[0].find("lines 9 to 11 are left out"), std::string::npos) << o.refusals[0];
}

TEST(RefusedEpochs, InCompactRinexTheRestIsLeftOutWhereNoEpochIsComplete) {
  std::string text = compact_file();
  text[text.rfind("\n1000") + 1] = 'x';
  const Observations o = parse_observations(text, "c.crx");
  EXPECT_EQ(o.epochs.size(), 3U);
  ASSERT_EQ(o.refused, 1);
  EXPECT_NE(o.refusals[0].find("lines 15 to 17 are left out"), std::string::npos) << o.refusals[0];
}

TEST(RefusedEpochs, TwoCompactFilesMayFollowEachOther) {
  std::string second = compact_file();
  for (std::size_t at = 0; (at = second.find("2021 01 01", at)) != std::string::npos;)
    second.replace(at, 10, "2021 01 02");
  const Observations o = parse_observations(compact_file() + second, "c.crx");
  EXPECT_EQ(o.epochs.size(), 8U);
  EXPECT_EQ(o.refused, 0);
}

}  // namespace
}  // namespace maploop::ppp
