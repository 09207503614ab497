// This file reads the scans in a capture of a Velodyne scanner's packets.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "sensors/source.h"
#include "sensors/velodyne/capture_reader.h"
#include "sensors/velodyne/velodyne_decoder.h"

namespace maploop::sensors {

struct VelodyneCaptureOptions {
  std::optional<VelodyneModel> model;  // if unset, taken from the data packets
  std::filesystem::path calibration;   // if empty, the model's own (not for an HDL-64E)
};

// Reads the first scanner in the capture, identified by its address. Stamps are on the capturing
// host's clock. An incomplete turn and damage of the file are reported as refused findings.
class VelodyneCapture final : public Source<LidarScan> {
 public:
  // Throws std::runtime_error that names the file: not a capture, no packet of a known scanner, or
  // a calibration that is missing or wrong.
  VelodyneCapture(const std::filesystem::path& file, const VelodyneCaptureOptions& options);

  bool next(LidarScan& scan) override;
  const SourceReport& report() const override { return report_; }

  VelodyneModel model() const { return model_; }
  const VelodyneDecoder& decoder() const { return decoder_; }
  std::uint64_t others() const { return others_ + reader_.others(); }  // packets of other origin
  // These are the times of the scanner's first and last packet so far.
  Time first() const { return first_; }
  Time last() const { return last_; }

 private:
  struct Scanner {
    VelodyneModel model;
    std::uint32_t address;
  };
  static Scanner find(const std::filesystem::path& file, std::optional<VelodyneModel> model);
  VelodyneCapture(const std::filesystem::path& file, const VelodyneCaptureOptions& options,
                  Scanner scanner);
  void end();

  std::filesystem::path file_;
  VelodyneModel model_;
  std::uint32_t address_;
  VelodyneDecoder decoder_;
  CaptureReader reader_;
  SourceReport report_;
  std::uint64_t others_ = 0;
  Time first_{}, last_{};
  Time last_stamp_ = Time::min(), last_available_ = Time::min();
};

}  // namespace maploop::sensors
