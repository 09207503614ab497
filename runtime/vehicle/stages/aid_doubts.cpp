#include "runtime/vehicle/stages/aid_doubts.h"

#include <algorithm>

#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {
namespace {

// The statistics that are judged have a memory of their own.
constexpr Duration doubt_interval = std::chrono::seconds(1);

// A sensor that has gone is not doubted for longer.
constexpr Duration doubt_memory = std::chrono::seconds(10);

constexpr const char* scattering = "they scatter more than they say of themselves";

}  // namespace

AidDoubts::AidDoubts(const fusion::ReducedImuFilter& filter)
    : filter_(filter),
      imu_(stages::fusion.name, "inertial samples", doubt_interval, doubts),
      gnss_(stages::fusion.name, "GNSS fixes", doubt_interval, doubts),
      wheel_(stages::fusion.name, "wheel speeds", doubt_interval, doubts),
      odometry_(stages::fusion.name, "motions", doubt_interval, doubts) {}

// Returns what is wrong with the fixes or the wheels, or nullptr.
const char* AidDoubts::doubt_of(fusion::Witness witness, int components) const {
  const fusion::LastingError& error = filter_.contradictions().of(witness);
  const fusion::FusionParameters& p = filter_.parameters();
  if (error.excess(components, p.doubt_scatter) > 1.0) return scattering;
  if (error.mean() > p.doubt_gate) return "they have contradicted the rest for seconds";
  return nullptr;
}

bool AidDoubts::any(Time t) const {
  using enum fusion::Witness;
  const auto lately = [&](fusion::Witness witness, int components) {
    const bool there = t - filter_.contradictions().of(witness).stamp <= doubt_memory;
    return there && doubt_of(witness, components) != nullptr;
  };
  // Where doubted fixes have moved the position, it stays there until good ones come.
  return !others_agree_ || doubt_of(fix_position, 2) != nullptr || lately(fix_velocity, 2) ||
         lately(wheel_speed, 1);
}

// An odometry that is wrong errs by much, so its motions scatter; where they err by a little, all
// in one direction, it is the inertial unit.
void AidDoubts::judge_motion(Time available) {
  using enum fusion::Witness;
  const fusion::FusionParameters& p = filter_.parameters();
  const fusion::LastingError& length = filter_.contradictions().of(motion_length);
  const fusion::LastingError& turn = filter_.contradictions().of(motion_turn);
  const bool scatter = std::max(length.scatter(), turn.scatter()) > p.doubt_scatter;
  const bool apart = std::max(length.mean(), turn.mean()) > p.doubt_motion_gate;
  odometry_.note(available, scatter ? scattering : nullptr);
  imu_.note(available, apart && !scatter ? "they have contradicted odometry for seconds" : nullptr);
  others_agree_ = !scatter && !apart;
}

// Where odometry and the inertial unit contradict each other, a fix is no third witness.
void AidDoubts::judge_fix(Time available) {
  using enum fusion::Witness;
  const char* position = doubt_of(fix_position, 2);
  const char* doubt = position != nullptr ? position : doubt_of(fix_velocity, 2);
  gnss_.note(available, others_agree_ ? doubt : nullptr);
}

void AidDoubts::judge_wheel(Time available) {
  wheel_.note(available, doubt_of(fusion::Witness::wheel_speed, 1));
}

}  // namespace maploop::vehicle
