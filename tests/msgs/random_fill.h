// Fills a struct with random values through its description, archive(), and checks that the
// description has every member of the struct.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <optional>
#include <random>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "msgs/imu.h"
#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop::testing {

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

// Initializes any member. (An optional takes it as its value.)
struct AnyMember {
  template <class T>
  requires(!is_optional<T>) operator T() const;
};

// Returns the number of members of an aggregate, each base class being one: as many as its
// initializer may have.
template <class T, class... Members>
constexpr std::size_t members_of() {
  if constexpr (requires { T{Members{}..., AnyMember{}}; }) {
    return members_of<T, Members..., AnyMember>();
  } else {
    return sizeof...(Members);
  }
}

// Returns how many values the archive of a type lists: its members, each base class being one.
template <class T>
constexpr std::size_t archived_values() {
  return members_of<T>();
}
// It lists the values of its second base one by one.
template <>
constexpr std::size_t archived_values<ImuSample>() {
  return 1 + members_of<InertialValues>();
}

struct MemberCounter {
  std::size_t count = 0;
  void operator()(const auto&... members) { count += sizeof...(members); }
};

class RandomFill {
 public:
  explicit RandomFill(unsigned seed) : random_(seed) {}

  template <class... T>
  void operator()(T&... values) {
    (fill(values), ...);
  }

 private:
  void fill(bool& value) { value = random_() % 2 == 0; }
  void fill(std::integral auto& value) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(random_());
  }
  void fill(std::floating_point auto& value) {
    using Number = std::remove_reference_t<decltype(value)>;
    value = std::uniform_real_distribution<Number>(-1000, 1000)(random_);
  }
  template <NamedEnum Enum>
  void fill(Enum& value) {
    value = static_cast<Enum>(random_() % count_of<Enum>);
  }
  // Within 1000 s, because some messages have seconds or microseconds as a double.
  void fill(Duration& value) {
    value = Duration(std::uniform_int_distribution(-1'000'000'000'000, 1'000'000'000'000)(random_));
  }
  void fill(Time& value) {
    value = from_nanoseconds(1'317'042'651'174'740'992);
    Duration later{};
    fill(later);
    value += later;
  }
  void fill(Sample& value) { (*this)(value.stamp, value.available, value.sequence); }
  void fill(std::string& value) { value = std::to_string(random_()); }
  template <class T>
  void fill(std::vector<T>& values) {
    values.resize(random_() % 4);
    for (T& value : values) fill(value);
  }
  template <class T, std::size_t n>
  void fill(std::array<T, n>& values) {
    for (T& value : values) fill(value);
  }
  template <class T>
  void fill(std::optional<T>& value) {
    value.reset();
    if (random_() % 2 == 0) fill(value.emplace());
  }
  template <int rows, int columns>
  void fill(Eigen::Matrix<double, rows, columns>& value) {
    for (double& element : value.reshaped()) fill(element);
  }
  void fill(Eigen::Quaterniond& value) { fill(value.coeffs()); }
  void fill(Eigen::Isometry3d& value) { fill(value.matrix()); }

  template <class T>
  requires requires(T& value, RandomFill& fill) { value.archive(fill); }
  void fill(T& value) {
    MemberCounter counter;
    value.archive(counter);
    EXPECT_EQ(counter.count, archived_values<T>()) << typeid(T).name() << "::archive";
    value.archive(*this);
  }

  std::mt19937_64 random_;
};

}  // namespace maploop::testing
