#include "sensors/replay/stereo_source.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "sensors/replay/files.h"
#include "sensors/replay/grey_png.h"

namespace maploop::sensors {
namespace {

class StereoSource final : public Source<StereoPair> {
 public:
  StereoSource(ImageFolder left, ImageFolder right, const StereoCalibration& calibration,
               Duration readout, Duration max_skew, Time passed)
      : left_(std::move(left)),
        right_(std::move(right)),
        calibration_(calibration),
        readout_(readout),
        passed_(passed) {
    judge_stamps(max_skew);
    for (const ImageFolder* folder : {&left_, &right_}) {
      auto found = files_without_stamp(folder->data, verdicts_.size());
      unstamped_.insert(unstamped_.end(), found.begin(), found.end());
    }
  }

  bool next(StereoPair& pair) override {
    while (index_ < verdicts_.size()) {
      const std::size_t i = index_++;
      if (verdicts_[i]) {
        report_.refuse(*verdicts_[i]);
        continue;
      }
      const bool wanted = available_[i] > passed_;
      if (wanted && !(read(left_, i, pair.left) && read(right_, i, pair.right))) continue;
      pair.stamp = stamps_[i];
      pair.available = available_[i];
      pair.sequence = i;
      ++report_.delivered;
      return true;
    }
    for (Finding& finding : unstamped_) report_.refuse(std::move(finding));
    unstamped_.clear();
    return false;
  }

  const SourceReport& report() const override { return report_; }

 private:
  void judge_stamps(Duration max_skew) {
    const Timestamps& left = left_.timestamps;
    const Timestamps& right = right_.timestamps;
    const std::size_t frames = std::max(left.size(), right.size());
    stamps_.resize(frames);
    available_.resize(frames);
    for (std::size_t i = 0; i < frames; ++i) {
      auto found = verdict(left, i);
      if (!found) found = verdict(right, i);
      if (!found) {
        const auto [earlier, later] = std::minmax(left.stamps[i], right.stamps[i]);
        stamps_[i] = earlier;
        available_[i] = later + readout_;
        const Duration skew = later - earlier;
        if (skew > max_skew) {
          found = Finding{right.file.string(), i + 1,
                          "differs from the left image's stamp by " +
                              std::to_string(to_seconds(skew)) + " s, more than max_pair_skew"};
        }
      }
      verdicts_.push_back(std::move(found));
    }
    refuse_out_of_order(stamps_, left.file, verdicts_);
    refuse_out_of_order(available_, right.file, verdicts_);
  }

  bool read(const ImageFolder& folder, std::size_t i, GreyImage& image) {
    constexpr std::size_t largest_file = std::size_t{64} << 20;
    const std::filesystem::path file = folder.data / numbered_file(i, ".png");
    try {
      read_file(file, largest_file, bytes_);
      decode_grey_png(bytes_, calibration_.width, calibration_.height, image);
      return true;
    } catch (const std::exception& error) {
      report_.refuse({file.string(), 0, error.what()});
      return false;
    }
  }

  ImageFolder left_;
  ImageFolder right_;
  StereoCalibration calibration_;
  Duration readout_;
  Time passed_;
  std::vector<Time> stamps_;
  std::vector<Time> available_;
  Verdicts verdicts_;
  std::vector<Finding> unstamped_;
  std::size_t index_ = 0;
  std::vector<char> bytes_;
  SourceReport report_;
};

}  // namespace

std::unique_ptr<Source<StereoPair>> make_stereo_source(ImageFolder left, ImageFolder right,
                                                       const StereoCalibration& calibration,
                                                       Duration readout, Duration max_skew,
                                                       Time passed) {
  return std::make_unique<StereoSource>(std::move(left), std::move(right), calibration, readout,
                                        max_skew, passed);
}

}  // namespace maploop::sensors
