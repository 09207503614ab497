#include "runtime/vehicle/config/config_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace maploop::vehicle {
namespace {

// Becomes a member of any kind: a struct can be made of as many as it has members.
struct AnyMember {
  template <class T>
  operator T() const;
};
template <class P, std::size_t... i>
constexpr bool can_be_made_of(std::index_sequence<i...>) {
  return requires {
    P{(static_cast<void>(i), AnyMember{})...};
  };
}
template <class P, std::size_t count = 0>
constexpr std::size_t member_count() {
  if constexpr (can_be_made_of<P>(std::make_index_sequence<count + 1>{})) {
    return member_count<P, count + 1>();
  } else {
    return count;
  }
}

std::string name_of(std::string_view table, const ParameterDescription& parameter) {
  return std::string(table) + '.' + std::string(parameter.key);
}

TEST(ConfigTables, EveryParameterHasAMeaningAndEveryNumberAUnitAndARangeAroundItsDefault) {
  const VehicleConfig defaults;
  each_part(defaults, [&](const auto& table, const auto& values) {
    for (const auto& parameter : table.parameters) {
      SCOPED_TRACE(name_of(table.name, parameter));
      EXPECT_GE(parameter.meaning.size(), 10U);
      const ParameterValue value = parameter.value_in(values);
      const bool number = std::holds_alternative<int>(value) ||
                          std::holds_alternative<std::int64_t>(value) ||
                          std::holds_alternative<double>(value);
      EXPECT_EQ(number, !parameter.unit.empty());
      EXPECT_EQ(number, parameter.least < parameter.most);
      EXPECT_FALSE(problem_of(parameter, value));
      EXPECT_EQ(parameter.choice.data.empty(), parameter.choice.figures.empty());
    }
    EXPECT_FALSE(problem_of(table, values)) << table.name;
  });
}

TEST(ConfigTables, EveryMemberOfAStructIsDescribedOnce) {
  const VehicleConfig defaults;
  std::set<std::string> names;
  each_part(defaults, [&]<class P>(const ParameterTable<P>& table, const P&) {
    for (const auto& parameter : table.parameters)
      EXPECT_TRUE(names.insert(name_of(table.name, parameter)).second) << parameter.key;
    if constexpr (!std::is_same_v<P, VehicleConfig>) {
      // [map] mode sets one member of the feedback's, [vehicle.imu] delay one of the replay's; the
      // filter of [ppp] has a table of its own, and so have the ground of that filter, and
      // position, rotation and time of a sensor.
      constexpr std::size_t others =
          std::is_same_v<P, mapmatch::FeedbackParameters> || std::is_same_v<P, PppConfig> ||
                  std::is_same_v<P, ppp::PppParameters> ||
                  std::is_same_v<P, sensors::KittiDriveParameters>
              ? 1
          : std::is_same_v<P, CameraDescription> || std::is_same_v<P, LidarDescription> ? 3
                                                                                        : 0;
      EXPECT_EQ(table.parameters.size() + others, member_count<P>()) << table.name;
    }
  });
}

TEST(ConfigTables, ANumberIsSetByItsKeyWhereItIsInItsRange) {
  fusion::GuardParameters guard;
  EXPECT_TRUE(set_number(guard, "patience", 7.0));
  EXPECT_EQ(guard.patience, 7.0);
  EXPECT_FALSE(set_number(guard, "patient", 7.0));
  EXPECT_THROW(set_number(guard, "patience", -1.0), std::invalid_argument);
  mapmatch::MatchParameters match;
  EXPECT_TRUE(set_number(match, "paths", 0.0));
  EXPECT_FALSE(match.paths);
}

}  // namespace
}  // namespace maploop::vehicle
