#include "mapmatch/doubt_collector.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double beyond_the_map = 100.0;  // m
constexpr double min_away = 30.0;     // m, shorter ways off the roads are entrances and car parks
constexpr double min_against = 20.0;  // m against a one-way direction
constexpr double min_link = 5.0;      // m, on a link that counts as driven
constexpr double min_beside = 40.0;   // m over which an offset is measured ...
constexpr double from_end = 15.0;     // m, ... so far from junctions, ...
constexpr double parallel = 0.2;      // rad, ... and like the link
constexpr double least_step = 10.0;   // m, between places if no speed is known
// These describe the roads that are shifted: their share of all roads, and how far they are
// shifted. The error of OpenStreetMap's positions is 6 m in the mean (Haklay, "How good is
// volunteered geographical information?", 2010).
constexpr double shifted_share = 0.02;
constexpr double shift_sigma = 10.0;  // m

}  // namespace

double probability_of_shift(double offset, double sigma, double half_width) {
  const auto density = [&](double spread) {
    const double s = std::hypot(spread, sigma);
    return std::exp(-0.5 * offset * offset / (s * s)) / s;
  };
  const double shifted = shifted_share * density(shift_sigma);
  return shifted / (shifted + (1.0 - shifted_share) * density(0.5 * half_width));
}

DoubtCollector::DoubtCollector(const RoadNetwork& network, const MatchParameters& parameters)
    : network_(&network), max_gap_(from_seconds(parameters.max_gap)) {
  area_ = {1e9, 1e9, -1e9, -1e9};
  for (const Vertex& v : network.data().vertices) {
    area_ = {std::min(area_.west, v.east - beyond_the_map),
             std::min(area_.south, v.north - beyond_the_map),
             std::max(area_.east, v.east + beyond_the_map),
             std::max(area_.north, v.north + beyond_the_map)};
  }
}

std::span<const MapDoubt> DoubtCollector::add(const LinkMatch& match, const VehicleFix& fix) {
  if (match.refusal == FixRefusal::out_of_reach) {  // what was before or is after it is wrong
    away_ = {};
    jumped_ = true;
    return finish();
  }
  found_count_ = 0;
  if (match.refusal != FixRefusal::none) return {};
  const Step step = advance(fix);
  follow_away(match, fix, step);
  follow_link(match, fix, step);
  return {found_.data(), found_count_};
}

std::span<const MapDoubt> DoubtCollector::finish() {
  found_count_ = 0;
  end_away({});
  leave_link();
  before_ = {};
  last_ = {};
  started_ = false;
  return {found_.data(), found_count_};
}

// Metres that were driven backwards do not count.
DoubtCollector::Step DoubtCollector::advance(const VehicleFix& fix) {
  const Eigen::Vector2d place = network_->to_local(fix.position);
  const double interval = to_seconds(fix.stamp - stamp_);
  if (!started_ || fix.stamp - stamp_ > max_gap_) {
    if (started_) finish();
    started_ = true;
    stamp_ = fix.stamp;
    place_ = place;
    return {place, 0.0};
  }
  stamp_ = fix.stamp;
  if (std::isfinite(fix.speed)) {
    place_ = place;
    return {place, std::max(fix.speed, 0.0) * interval};
  }
  // Positions move by their noise, too.
  const double moved = (place - place_).norm();
  if (moved < least_step) return {place, 0.0};
  place_ = place;
  return {place, moved};
}

MapDoubt::Segment DoubtCollector::segment_at(DirectedLink link, double along) const {
  MapDoubt::Segment segment;
  const std::uint32_t vertex = network_->at(link, along).vertex;
  segment.link = link;
  segment.way_id = network_->road_at(vertex).way_id;
  std::tie(segment.node_a, segment.node_b) = network_->nodes(link, vertex);
  return segment;
}

MapDoubt& DoubtCollector::add_doubt(DoubtKind kind, const Visit& visit, double probability) {
  MapDoubt& doubt = found_[found_count_++];
  doubt = {};
  doubt.kind = kind;
  doubt.stamp = stamp_;
  doubt.probability = probability;
  doubt.from = visit.segment;
  visit.stretch.describe(doubt);
  return doubt;
}

void DoubtCollector::follow_away(const LinkMatch& match, const VehicleFix& fix, const Step& step) {
  if (match.on_road && match.off_road < may_have_left) {
    last_ = segment_at(match.link, match.along);
    jumped_ = false;
    return end_away(last_);
  }
  const double x = step.place.x(), y = step.place.y();
  if (!area_.meets({x, y, x, y})) return end_away({});
  if (!away_.there) {
    if (jumped_) return;
    away_ = {};
    away_.there = true;
    away_.segment = match.on_road ? segment_at(match.link, match.along) : last_;
    away_.stretch = DriveStretch(fix.stamp);
  }
  away_.sure = away_.sure || !match.on_road;
  away_.stretch.add(fix.position, step.metres, match.off_road);
}

void DoubtCollector::end_away(const MapDoubt::Segment& to) {
  if (away_.there && away_.sure && away_.stretch.length() >= min_away)
    add_doubt(DoubtKind::missing_road, away_, away_.stretch.probability()).to = to;
  away_ = {};
}

void DoubtCollector::follow_link(const LinkMatch& match, const VehicleFix& fix, const Step& step) {
  if (!match.on_road) {
    // How far the link was really driven is not known.
    link_ = {};
    before_ = {};
    return;
  }
  if (!link_.there || !(link_.segment.link == match.link)) {
    leave_link();
    link_.there = true;
    link_.segment = segment_at(match.link, match.along);
    link_.stretch = DriveStretch(fix.stamp);
  }
  link_.stretch.add(fix.position, step.metres, match.probability);
  measure_offset(match, fix, step);
}

void DoubtCollector::measure_offset(const LinkMatch& match, const VehicleFix& fix,
                                    const Step& step) {
  const double left = network_->link(match.link.link).length - match.along;
  const LinkPoint point = network_->at(match.link, match.along);
  if (match.along < from_end || left < from_end ||
      std::abs(wrap_angle(fix.azimuth - point.azimuth())) > parallel)
    return;
  const Eigen::Vector2d right(point.direction.y(), -point.direction.x());
  link_.offset += step.metres * right.dot(step.place - point.position);
  link_.variance += step.metres * right.dot(fix.covariance * right);
  link_.judged += step.metres;
}

void DoubtCollector::leave_link() {
  if (link_.there && link_.stretch.length() >= min_link) {
    if (!network_->allowed(link_.segment.link) && link_.stretch.length() >= min_against)
      add_doubt(DoubtKind::wrong_direction, link_, link_.stretch.probability());
    judge_turn(link_);
    judge_offset(link_);
    std::shift_right(before_.begin(), before_.end(), 1);
    before_[0] = {link_.segment, link_.stretch.probability()};
  }
  link_ = {};
}

// The link that was driven before is the newest that leads to this one.
void DoubtCollector::judge_turn(const Visit& to) {
  const DirectedLink into = to.segment.link;
  const auto from = std::find_if(before_.begin(), before_.end(), [&](const Driven& d) {
    return d.segment.way_id != 0 &&
           network_->end_junction(d.segment.link) == network_->start_junction(into);
  });
  if (from == before_.end() || network_->allowed_turn(from->segment.link, into)) return;
  MapDoubt& doubt =
      add_doubt(DoubtKind::forbidden_turn, to, from->probability * to.stretch.probability());
  // A link may have several ways: those of a restriction meet at the junction.
  const DirectedLink out = from->segment.link;
  doubt.from = segment_at(out, network_->link(out.link).length);
  doubt.to = segment_at(into, 0.0);
}

void DoubtCollector::judge_offset(const Visit& visit) {
  if (visit.judged < min_beside || visit.stretch.probability() < 0.5) return;
  const double offset = visit.offset / visit.judged;
  const double sigma = std::sqrt(visit.variance / visit.judged);
  const auto& road = network_->road_at(network_->link(visit.segment.link.link).first_vertex);
  MapDoubt& doubt = add_doubt(DoubtKind::shifted_road, visit,
                              probability_of_shift(offset, sigma, half_width(road)));
  doubt.offset = offset;
  doubt.offset_sigma = sigma;
}

}  // namespace maploop::mapmatch
