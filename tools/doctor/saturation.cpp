#include "tools/doctor/saturation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>

#include "sensors/imu/aligned_imu.h"

namespace maploop::tools {
namespace {

struct Axis {
  const char* name;
  double InertialValues::*value;
  bool of_six;  // only a unit of six axes has it
};

constexpr std::array axes{
    Axis{"specific force forward", &InertialValues::specific_force_forward, false},
    Axis{"specific force to the left", &InertialValues::specific_force_left, false},
    Axis{"specific force upward", &InertialValues::specific_force_up, true},
    Axis{"roll rate", &InertialValues::roll_rate, true},
    Axis{"pitch rate", &InertialValues::pitch_rate, true},
    Axis{"yaw rate", &InertialValues::yaw_rate, false},
};

// `sorted` begins with the end of the range.
template <class Iterator>
bool piles_up(Iterator begin, Iterator end) {
  std::array<std::ptrdiff_t, 4> counts{};  // of the first distinct values
  Iterator at = begin;
  for (std::ptrdiff_t& count : counts) {
    if (at == end) return false;  // too few different values
    const Iterator next = std::find_if(at, end, [&](double v) { return v != *at; });
    count = next - at;
    at = next;
  }
  constexpr std::ptrdiff_t least = 5;
  return counts[0] >= least && counts[0] > 3 * std::max({counts[1], counts[2], counts[3]}) &&
         2 * counts[0] < end - begin;
}

}  // namespace

bool is_cut_off(std::vector<double> values) {
  std::ranges::sort(values);
  return piles_up(values.begin(), values.end()) || piles_up(values.rbegin(), values.rend());
}

std::vector<std::string> cut_off_axes(const vehicle::Recording& recording) {
  std::vector<std::string> sentences;
  const auto imu = recording.sensors(Time::max()).imu;
  if (imu == nullptr || dynamic_cast<const sensors::AlignedImu*>(imu.get()) != nullptr)
    return sentences;
  std::array<std::vector<double>, axes.size()> values;
  bool six_axes = false;
  for (ImuSample sample; imu->next(sample);) {
    six_axes = six_axes || sample.six_axes;
    for (std::size_t i = 0; i < axes.size(); ++i) values[i].push_back(sample.*axes[i].value);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if ((six_axes || !axes[i].of_six) && is_cut_off(std::move(values[i]))) {
      sentences.push_back(
          fmt::format("The {} of imu is cut off at the end of its range: what is larger is lost.",
                      axes[i].name));
    }
  }
  return sentences;
}

std::vector<std::string> cut_off_images(const vehicle::Recording& recording,
                                        const extrinsics::Stretch& stretch) {
  const auto camera = recording.sensors(stretch.from).camera;
  if (camera == nullptr) return {};
  std::uint64_t white = 0, black = 0, all = 0;
  for (StereoPair pair; camera->next(pair) && pair.stamp <= stretch.to;) {
    if (!stretch.contains(pair.stamp)) continue;
    const auto& pixels = pair.left.pixels;
    white += static_cast<std::uint64_t>(std::ranges::count(pixels, std::uint8_t{255}));
    black += static_cast<std::uint64_t>(std::ranges::count(pixels, std::uint8_t{0}));
    all += pixels.size();
  }
  if (all == 0) return {};
  std::vector<std::string> sentences;
  const auto judge = [&](std::uint64_t count, const char* what, const char* remedy) {
    const double share = static_cast<double>(count) / static_cast<double>(all);
    if (share > 0.25) {
      sentences.push_back(fmt::format("{:.0f} % of the pixels of camera are entirely {}: {}.",
                                      100.0 * share, what, remedy));
    }
  };
  judge(white, "white", "expose shorter");
  judge(black, "black", "expose longer, or light the scene");
  return sentences;
}

}  // namespace maploop::tools
