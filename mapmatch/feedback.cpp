#include "mapmatch/feedback.h"

#include <algorithm>
#include <cmath>

#include "mapmatch/foot_point.h"
#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

Eigen::Vector2d direction(double azimuth) {
  return {std::sin(azimuth), std::cos(azimuth)};
}

double azimuth_of(const Eigen::Vector2d& step) {
  return std::atan2(step.x(), step.y());
}

// Returns the variance of a covariance in a direction.
double variance_along(const Eigen::Matrix2d& covariance, const Eigen::Vector2d& u) {
  return u.dot(covariance * u);
}

}  // namespace

Feedback::Feedback(const RoadNetwork& network, const FeedbackParameters& parameters)
    : network_(&network), parameters_(parameters) {
  validate_parameters(parameters_);
}

Feedback::Line Feedback::line_beside(DirectedLink link, const Eigen::Vector2d& place) const {
  const double length = network_->link(link.link).length;
  const auto vertices = network_->shape(link.link);
  double best = 1e300, along = 0.0;
  std::size_t segment = 0;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const Eigen::Vector2d a = vertices[i].position();
    const Eigen::Vector2d step = vertices[i + 1].position() - a;
    const double share = foot_share(place, a, step);
    const double distance = (place - a - share * step).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    segment = i;
    along = vertices[i].along + share * (vertices[i + 1].along - vertices[i].along);
  }
  Line line;
  line.along = link.forward ? along : length - along;
  const LinkPoint at = network_->at(link, line.along);
  line.point = at.position;
  const auto step_to = [&](double from, double to) {
    return Eigen::Vector2d(network_->at(link, to).position - network_->at(link, from).position);
  };
  const double before = std::max(0.0, line.along - parameters_.chord);
  const double behind = std::min(length, line.along + parameters_.chord);
  line.azimuth = azimuth_of(behind - before > 1.0 ? step_to(before, behind) : at.direction);
  const double reach = 2.0 * parameters_.chord;
  if (line.along > reach && line.along < length - reach) {
    const double bend = wrap_angle(azimuth_of(step_to(line.along, line.along + reach)) -
                                   azimuth_of(step_to(line.along - reach, line.along)));
    line.straight = std::abs(bend) < parameters_.straight;
  }
  const Road& road = network_->road_at(network_->link(link.link).first_vertex +
                                       static_cast<std::uint32_t>(segment));
  line.half_width = half_width(road);
  if (road.forward && road.backward && !parameters_.hard_reset) {
    line.lane =
        (network_->left_hand_traffic() ? -0.5 : 0.5) * parameters_.lane_share * line.half_width;
  }
  return line;
}

// Returns whether the filter's azimuth is too uncertain for a comparison, for example after a gap
// of the gyro.
bool Feedback::lost(const VehicleFix& fix) const {
  return parameters_.azimuth_sigmas * fix.azimuth_sigma > parameters_.max_azimuth_error;
}

// Returns whether the azimuth relative to the link's has changed within the last `interval`
// seconds.
bool Feedback::turns(Time stamp, double azimuth_error, double interval) const {
  const std::size_t known = std::min(next_moment_, history_length);
  for (std::size_t i = 1; i <= known; ++i) {
    const Moment& m = history_[(next_moment_ - i) % history_length];
    if (to_seconds(stamp - m.stamp) > interval) break;
    if (std::abs(wrap_angle(azimuth_error - m.azimuth_error)) > parameters_.max_turn) return true;
  }
  return false;
}

// Returns whether the vehicle may be on a parallel road that is not a continuation of this one.
bool Feedback::parallel(const LinkMatch& match, const VehicleFix& fix, const Line& line) const {
  const Eigen::Vector2d place = network_->to_local(fix.position);
  const Eigen::Vector2d right(std::cos(line.azimuth), -std::sin(line.azimuth));
  const double sigma = std::sqrt(variance_along(fix.covariance, right) +
                                 parameters_.map_sigma * parameters_.map_sigma);
  const double own = std::abs(right.dot(place - line.point));
  for (std::size_t i = 0; i < match.candidate_count; ++i) {
    const MatchCandidate& c = match.candidates[i];
    if (c.link.link == match.link.link || c.probability < 1e-3) continue;
    const Line other = line_beside(c.link, place);
    const double length = network_->link(c.link.link).length;
    if (other.along <= 0.0 || other.along >= length) continue;  // ahead or behind, not beside
    const double turn = wrap_angle(other.azimuth - line.azimuth);
    if (std::abs(turn) > parameters_.parallel_azimuth) continue;
    const double off = std::abs(right.dot(place - other.point));
    if (off < own + parameters_.parallel_sigmas * sigma && match.margin < 0.99) return true;
  }
  return false;
}

void Feedback::note_nis(double nis) {
  window_[next_nis_ % window_.size()] = nis;
  ++next_nis_;
}

bool Feedback::consistent() const {
  const auto length = static_cast<std::size_t>(parameters_.window);
  if (next_nis_ < length) return true;
  double sum = 0.0;
  for (std::size_t i = 1; i <= length; ++i) sum += window_[(next_nis_ - i) % window_.size()];
  return sum / static_cast<double>(length) <= parameters_.max_mean_nis;
}

FeedbackReason Feedback::check(const LinkMatch& match, const VehicleFix& fix, const Line& line) {
  const double azimuth_error = wrap_angle(fix.azimuth - line.azimuth);
  const bool turning =
      turns(fix.stamp, azimuth_error,
            lost(fix) ? parameters_.lost_turn_interval : parameters_.turn_interval);
  history_[next_moment_ % history_length] = {fix.stamp, azimuth_error};
  ++next_moment_;
  if (match.phase == MatchPhase::initial) return FeedbackReason::not_established;
  if (match.phase == MatchPhase::at_junction) return FeedbackReason::link_changed;
  if (!(fix.speed >= parameters_.min_speed)) return FeedbackReason::too_slow;
  // A lost azimuth is corrected from the road if the link is certain.
  const double lost_azimuth =
      std::min(parameters_.azimuth_sigmas * fix.azimuth_sigma, parameters_.max_lost_azimuth);
  if (!(std::abs(azimuth_error) <= std::max(parameters_.max_azimuth_error, lost_azimuth)))
    return FeedbackReason::azimuth_differs;
  if (turning) return FeedbackReason::turning;
  const double sigma_along = std::sqrt(variance_along(fix.covariance, direction(line.azimuth)));
  const double least =
      std::max(parameters_.junction_distance, parameters_.junction_sigmas * sigma_along);
  const double length = network_->link(match.link.link).length;
  if (std::min(line.along, length - line.along) < least) return FeedbackReason::near_junction;
  if (match.probability < parameters_.min_probability) return FeedbackReason::link_doubtful;
  if (match.margin < parameters_.min_margin) return FeedbackReason::ambiguous;
  return FeedbackReason::none;
}

MapFeedback Feedback::decide(const LinkMatch& match, const VehicleFix& fix) {
  MapFeedback out;
  out.stamp = fix.stamp;
  out.sequence = sequence_++;
  if (match.refusal != FixRefusal::none) return out;
  const double interval = started_ ? to_seconds(fix.stamp - stamp_) : 0.0;
  started_ = true;
  stamp_ = fix.stamp;
  if (std::isfinite(fix.speed)) odometer_ += std::abs(fix.speed) * interval;
  if (!match.on_road) {
    out.reason = FeedbackReason::off_road;
    on_link_ = false;
    return out;
  }
  out.probability = match.probability;
  const Road& road = network_->road_at(network_->at(match.link, match.along).vertex);
  out.off_ground = road.bridge || road.tunnel || road.layer != 0;
  if (!std::isfinite(fix.azimuth)) {  // the vehicle stands or moves too slowly
    out.reason = FeedbackReason::too_slow;
    return out;
  }
  if (!on_link_ || !(match.link == link_)) {
    link_ = match.link;
    on_link_ = true;
    fed_on_link_ = 0;
    next_moment_ = 0;
  }
  const Eigen::Vector2d place = network_->to_local(fix.position);
  const Line line = line_beside(match.link, place);
  const Eigen::Vector2d right(std::cos(line.azimuth), -std::sin(line.azimuth));
  const Eigen::Vector2d lane = line.point + line.lane * right;
  out.point = network_->to_geodetic(lane);
  out.point.height = fix.position.height;
  out.link_azimuth = line.azimuth;
  out.cross_track = right.dot(place - lane);  // (15) of METHOD.md
  const double ramp = fed_on_link_ < parameters_.ramp ? parameters_.ramp_factor : 1.0;
  out.cross_sigma = ramp * parameters_.cross_sigma;
  // (16) of METHOD.md
  out.lane_sigma = std::sqrt(parameters_.map_sigma * parameters_.map_sigma +
                             line.half_width * line.half_width / 3.0);
  out.azimuth_sigma = parameters_.azimuth_sigma;
  if (has_road_ && std::abs(wrap_angle(fix.azimuth - road_azimuth_)) > parameters_.new_road_turn)
    turned_ = true;

  out.reason = check(match, fix, line);
  if (out.reason != FeedbackReason::none) return out;
  if (parameters_.hard_reset) {
    out.position = out.azimuth = out.reset = true;
    return out;
  }
  if (odometer_ - position_fed_at_ < parameters_.spacing) {
    out.reason = FeedbackReason::not_yet;
    return out;
  }
  const double allowed = variance_along(fix.covariance, right) + out.lane_sigma * out.lane_sigma +
                         out.cross_sigma * out.cross_sigma;
  note_nis(out.cross_track * out.cross_track / allowed);  // (17) of METHOD.md
  out.azimuth =
      lost(fix) || (line.straight && odometer_ - azimuth_fed_at_ >= parameters_.azimuth_spacing);
  if (!line.straight) out.azimuth_sigma = parameters_.bend_sigma;
  if (parallel(match, fix, line)) {
    out.reason = FeedbackReason::ambiguous;
    if (!out.azimuth) return out;
    out.reason = FeedbackReason::none;
  } else if (!consistent()) {
    out.reason = FeedbackReason::inconsistent;
    out.azimuth = false;
    position_fed_at_ = odometer_;
    return out;
  } else {
    out.position = true;
    out.new_road = turned_ || !has_road_;
    position_fed_at_ = odometer_;
    ++fed_on_link_;
    has_road_ = true;
    turned_ = false;
    road_azimuth_ = fix.azimuth;
  }
  if (out.azimuth) azimuth_fed_at_ = odometer_;
  if (out.azimuth && lost(fix))
    next_moment_ = 0;  // the correction changes the azimuth without a turn
  return out;
}

}  // namespace maploop::mapmatch
