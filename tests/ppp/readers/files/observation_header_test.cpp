// Tests headers of observation files: names of signals, and fields that no position needs.
#include "ppp/readers/files/observation_header.h"

#include <gtest/gtest.h>

#include "ppp/readers/files/observation.h"
#include "ppp/unused_signals.h"
#include "tests/ppp/readers/files/header_record.h"

namespace maploop::ppp {
namespace {

// A header of a version with one list of types and one record more.
std::string observation_header(const std::string& version, const std::string& types,
                               const std::string& more = {}) {
  const bool three = version >= "3";
  return maploop::testing::header_record("     " + version + "           OBSERVATION DATA    M",
                                         "RINEX VERSION / TYPE") +
         maploop::testing::header_record(types,
                                         three ? "SYS / # / OBS TYPES" : "# / TYPES OF OBSERV") +
         more + maploop::testing::header_record("", "END OF HEADER");
}

ObservationType type(const std::string& text, System system, std::size_t index) {
  return parse_observations(text, "o").header.types[static_cast<std::size_t>(system)].at(index);
}

std::string name(const ObservationType& t) {
  return t.signal < 0 ? "not kept" : std::string{t.kind, t.band, t.attribute};
}

TEST(ObservationHeader, LettersOfRinex212AreCivilSignals) {
  const std::string text = observation_header("2.12", "     6    CA    LA    CB    CC    LC    CD");
  EXPECT_EQ(name(type(text, System::gps, 0)), "C1C");
  EXPECT_EQ(name(type(text, System::glonass, 1)), "L1C");
  EXPECT_EQ(name(type(text, System::qzss, 2)), "C1X");
  EXPECT_EQ(name(type(text, System::gps, 3)), "C2X");
  EXPECT_EQ(name(type(text, System::gps, 4)), "L2X");
  EXPECT_EQ(name(type(text, System::glonass, 5)), "C2C");
  EXPECT_EQ(name(type(text, System::gps, 5)), "not kept");
  EXPECT_EQ(name(type(text, System::galileo, 0)), "not kept");
}

TEST(ObservationHeader, OfTwoColumnsOfOneSignalTheOneWithAValueCounts) {
  const std::string epoch = " 21  1  1  0  0  0.0000000  0  1G05\n";
  const std::string value = "  20000000.000  ", nothing(16, ' ');
  for (const std::string& line : {value + nothing, nothing + value}) {
    std::string text = observation_header("2.12", "     2    C1    CA");
    for (const std::string& part : {epoch, line, std::string("\n")}) text += part;
    const Observations o = parse_observations(text, "o");
    ASSERT_EQ(o.epochs.size(), 1U);
    ASSERT_EQ(o.epochs[0].signals.size(), 1U);
    EXPECT_DOUBLE_EQ(o.epochs[0].signals[0].code, 2e7);
  }
}

TEST(ObservationHeader, BeiDous1IIsB1IInEachVersion) {
  for (const std::string version : {"3.02", "3.03", "3.04"}) {
    const std::string text = observation_header(version, "C    3 C1I L1I C1X");
    EXPECT_EQ(name(type(text, System::beidou, 0)), "C2I") << version;
    EXPECT_EQ(name(type(text, System::beidou, 1)), "L2I") << version;
    EXPECT_EQ(name(type(text, System::beidou, 2)), version == "3.02" ? "C2X" : "C1X") << version;
  }
}

TEST(ObservationHeader, ASystemWithoutUsefulTypesIsNamed) {
  const auto unused = [](const std::string& types) {
    return unused_systems(parse_observations(observation_header("3.04", types), "o").header);
  };
  EXPECT_TRUE(unused("G    2 C1C L1C").empty());
  ASSERT_EQ(unused("E    2 C5Q L5Q").size(), 1U);
  EXPECT_NE(unused("E    2 C5Q L5Q")[0].find("system E is used: of its observations (C5Q L5Q)"),
            std::string::npos);
}

TEST(ObservationHeader, FieldsThatNoPositionNeedsMayBeBlankOrWrong) {
  for (const std::string& more :
       {maploop::testing::header_record("", "INTERVAL"),
        maploop::testing::header_record("", "TIME OF LAST OBS"),
        maploop::testing::header_record("", "TIME OF FIRST OBS"),
        maploop::testing::header_record("     0     0     0     0     0    0.0000000     GPS",
                                        "TIME OF FIRST OBS")}) {
    const ObservationHeader h =
        parse_observations(observation_header("3.04", "G    2 C1C H1C", more), "o").header;
    EXPECT_EQ(h.interval, 0.0);
    EXPECT_FALSE(h.first);
    EXPECT_FALSE(h.last);
    EXPECT_EQ(name(h.types[0].at(1)), "not kept");
  }
}

TEST(ObservationHeader, ATimeSystemThatIsUnknownIsAnError) {
  const auto with = [](const std::string& date, const std::string& system) {
    return observation_header(
        "3.04", "G    1 C1C",
        maploop::testing::header_record(date + "     " + system, "TIME OF FIRST OBS"));
  };
  const std::string date = "  2021     1     1     0     0    0.0000000";
  const std::string none(date.size(), ' ');
  EXPECT_THROW(parse_observations(with(date, "UTC"), "o"), ReadError);
  EXPECT_THROW(parse_observations(with(none, "UTC"), "o"), ReadError);
  EXPECT_THROW(parse_observations(with(none, "GLO"), "o"), ReadError) << "of which leap seconds";
  EXPECT_NO_THROW(parse_observations(with(date, "GLO"), "o"));
}

}  // namespace
}  // namespace maploop::ppp
