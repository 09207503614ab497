#include "sensors/replay/gnss_aid.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sensors/replay/normal_generator.h"

namespace maploop::sensors {
namespace {

void require(bool ok, const std::string& what) {
  if (!ok) throw std::invalid_argument("GNSS aid: " + what);
}

Eigen::Vector3d normal_vector(NormalGenerator& generator) {
  Eigen::Vector3d v;
  for (double& component : v) component = generator.next();
  return v;
}

}  // namespace

GnssAid::GnssAid(const GnssAidParameters& parameters) : parameters_(parameters) {
  const auto& p = parameters_;
  const auto is_sigma = [](double sigma) { return std::isfinite(sigma) && sigma >= 0.0; };
  require(p.rate >= 1e-3 && p.rate <= 1e3, "rate must be within 0.001 to 1000 Hz");
  require(is_sigma(p.white_position), "white_position must be 0 or more");
  require(is_sigma(p.markov_position), "markov_position must be 0 or more");
  require(p.markov_time > 0.0 && std::isfinite(p.markov_time), "markov_time must be positive");
  require(is_sigma(p.white_velocity), "white_velocity must be 0 or more");
  period_ = from_seconds(1.0 / p.rate);
}

bool GnssAid::offer(Time stamp, const Geodetic& position, const Eigen::Vector3d& velocity_enu,
                    GnssFix& fix) {
  const bool first = !first_;
  if (first) first_ = stamp;
  const std::int64_t period = (stamp - *first_) / period_;
  if (!first && period <= last_period_) return false;

  NormalGenerator generator(static_cast<std::uint64_t>(parameters_.seed), stamp);
  const Eigen::Vector3d white = parameters_.white_position * normal_vector(generator);
  const Eigen::Vector3d driving = parameters_.markov_position * normal_vector(generator);
  const double kept = first ? 0.0 : std::exp(-to_seconds(stamp - last_) / parameters_.markov_time);
  markov_enu_ = kept * markov_enu_ + std::sqrt(1.0 - kept * kept) * driving;

  fix.stamp = stamp;
  fix.sequence = static_cast<std::uint64_t>(period);
  fix.position = LocalFrame(position).to_geodetic(white + markov_enu_);
  fix.position_covariance = (parameters_.white_position * parameters_.white_position +
                             parameters_.markov_position * parameters_.markov_position) *
                            Eigen::Matrix3d::Identity();
  fix.velocity_enu = velocity_enu + parameters_.white_velocity * normal_vector(generator);
  fix.velocity_covariance =
      parameters_.white_velocity * parameters_.white_velocity * Eigen::Matrix3d::Identity();
  last_ = stamp;
  last_period_ = period;
  return true;
}

}  // namespace maploop::sensors
