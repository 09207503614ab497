#include "tools/odometry/summary.h"

#include <algorithm>
#include <iomanip>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

namespace maploop::odometry {
namespace {

const RelativeMotion& motion_of(const Step& step) {
  return step.motion;
}
const RelativeMotion& motion_of(const LidarStep& step) {
  return step.odometry;
}

std::string status_of(const Step& step) {
  std::string status(to_string(step.motion.status));
  if (step.motion.condition != OdometryCondition::ordinary)
    status += " (" + std::string(to_string(step.motion.condition)) + ")";
  return status;
}
std::string status_of(const LidarStep& step) {
  return std::string(step.with_scan ? to_string(step.lidar.status) : "no scan");
}

template <class AnyStep>
void write_frames(const std::vector<AnyStep>& steps, std::ostream& text) {
  std::map<std::string, int> by_status;
  double way = 0.0;
  for (const AnyStep& step : steps) {
    ++by_status[status_of(step)];
    way += motion_of(step).translation.norm();
  }
  text << "frames " << steps.front().frame << " to " << steps.back().frame << ", "
       << to_seconds(motion_of(steps.back()).stamp - motion_of(steps.front()).stamp) << " s, "
       << way << " m\n";
  for (const auto& [status, count] : by_status) text << "  " << status << ": " << count << '\n';
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::string summary(const std::vector<Step>& steps) {
  std::ostringstream text;
  write_frames(steps, text);
  std::vector<double> whole;  // of the frames that were compared with another
  std::vector<std::pair<std::string, std::vector<double>>> stages;  // as they follow each other
  for (const Step& step : steps) {
    if (step.motion.status == OdometryStatus::first_frame) continue;
    whole.push_back(step.milliseconds);
    std::map<std::string, double> of_step;
    for (const auto& [name, milliseconds] : step.stages) {
      of_step[name] += milliseconds;
      const auto same = [&n = name](const auto& stage) { return stage.first == n; };
      if (std::none_of(stages.begin(), stages.end(), same)) stages.push_back({name, {}});
    }
    for (auto& [name, times] : stages)
      if (const auto found = of_step.find(name); found != of_step.end())
        times.push_back(found->second);
  }
  if (whole.empty()) return text.str();
  stages.emplace_back("all", std::move(whole));
  text << "processor time of a frame, ms\n              median      p99  largest\n";
  for (const auto& [name, times] : stages) {
    text << "  " << std::left << std::setw(10) << name << std::right << std::fixed
         << std::setprecision(2);
    for (const double share : {0.5, 0.99, 1.0}) text << std::setw(9) << percentile(times, share);
    text << '\n';
  }
  return text.str();
}

std::string summary(const std::vector<LidarStep>& steps) {
  std::ostringstream text;
  write_frames(steps, text);
  std::map<std::string_view, int> by_direction;
  std::vector<double> milliseconds;
  int iterations = 0;
  for (const LidarStep& step : steps) {
    if (!step.with_scan) continue;
    for (unsigned k = 0; k < 6; ++k)
      if ((step.lidar.degenerate >> k & 1u) != 0)
        ++by_direction[to_string(static_cast<MotionDirection>(k))];
    milliseconds.push_back(step.milliseconds);
    iterations += step.lidar.iterations;
  }
  for (const auto& [direction, count] : by_direction)
    text << "  not determined by the scan, " << direction << ": " << count << '\n';
  if (milliseconds.empty()) return text.str();
  text << "processor time a scan: median " << percentile(milliseconds, 0.5) << " ms, p95 "
       << percentile(milliseconds, 0.95) << " ms, largest " << percentile(milliseconds, 1.0)
       << " ms; iterations a scan: "
       << static_cast<double>(iterations) / static_cast<double>(milliseconds.size()) << '\n';
  return text.str();
}

}  // namespace maploop::odometry
