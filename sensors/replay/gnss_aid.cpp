#include "sensors/replay/gnss_aid.h"

#include <cmath>

#include "sensors/replay/normal_generator.h"
#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {
namespace {

// These streams keep the drawn numbers apart from the noise of the same seed and stamp.
constexpr std::uint64_t gnss_sizes_stream = 0x7369'7a65'7300'0000;
constexpr std::uint64_t steps_stream = 0x7374'6570'7300'0000;

constexpr double step_time = 10.0;  // s, mean

Eigen::Vector3d normal_vector(NormalGenerator& generator) {
  Eigen::Vector3d v;
  for (double& component : v) component = generator.next();
  return v;
}

}  // namespace

GnssErrors errors_of(const GnssAidParameters& p) {
  GnssErrors e{p.white_position, p.markov_position, p.markov_time, p.white_velocity};
  if (p.errors == ErrorModel::given) return e;
  NormalGenerator draw(static_cast<std::uint64_t>(p.seed) ^ gnss_sizes_stream, Time{});
  e.white_position *= draw.log_uniform(0.3, 1.5);
  e.markov_position *= draw.log_uniform(0.7, 2.0);
  e.markov_time = draw.log_uniform(5.0, 600.0);
  e.white_velocity *= draw.log_uniform(0.5, 2.0);
  e.step_share = draw.uniform(0.0, 0.05);
  return e;
}

GnssAid::GnssAid(const GnssAidParameters& parameters)
    : parameters_(parameters), errors_(errors_of(parameters)) {
  validate_parameters(parameters_);
  period_ = from_seconds(1.0 / parameters_.rate);
}

bool GnssAid::offer(Time stamp, const Geodetic& position, const Eigen::Vector3d& velocity_enu,
                    GnssFix& fix) {
  const bool first = !first_;
  if (first) first_ = stamp;
  const std::int64_t period = (stamp - *first_) / period_;
  if (!first && period <= last_period_) return false;

  NormalGenerator generator(static_cast<std::uint64_t>(parameters_.seed), stamp);
  const Eigen::Vector3d white = errors_.white_position * normal_vector(generator);
  const Eigen::Vector3d driving = errors_.markov_position * normal_vector(generator);
  const double kept = first ? 0.0 : std::exp(-to_seconds(stamp - last_) / errors_.markov_time);
  markov_enu_ = kept * markov_enu_ + std::sqrt(1.0 - kept * kept) * driving;

  fix.stamp = stamp;
  fix.sequence = static_cast<std::uint64_t>(period);
  fix.position = LocalFrame(position).to_geodetic(white + markov_enu_ + step(stamp));
  fix.position_covariance = (parameters_.white_position * parameters_.white_position +
                             parameters_.markov_position * parameters_.markov_position) *
                            Eigen::Matrix3d::Identity();
  fix.velocity_enu = velocity_enu + errors_.white_velocity * normal_vector(generator);
  fix.velocity_covariance =
      parameters_.white_velocity * parameters_.white_velocity * Eigen::Matrix3d::Identity();
  last_ = stamp;
  last_period_ = period;
  return true;
}

// Models a Markov chain of two states: inside a step or outside.
Eigen::Vector3d GnssAid::step(Time stamp) {
  if (errors_.step_share <= 0.0) return Eigen::Vector3d::Zero();
  NormalGenerator draw(static_cast<std::uint64_t>(parameters_.seed) ^ steps_stream, stamp);
  const double ends = 1.0 - std::exp(-to_seconds(period_) / step_time);
  const double begins = ends * errors_.step_share / (1.0 - errors_.step_share);
  const bool changes = draw.uniform(0.0, 1.0) < (in_step_ ? ends : begins);
  if (changes) {
    in_step_ = !in_step_;
    step_enu_ = in_step_ ? Eigen::Vector3d(errors_.step_size * normal_vector(draw))
                         : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  return step_enu_;
}

}  // namespace maploop::sensors
