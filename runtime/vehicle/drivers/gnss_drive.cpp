#include "runtime/vehicle/drivers/gnss_drive.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;

ppp::FileKind kind_of(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? ppp::kind_of_file(path) : ppp::FileKind::unknown;
}

bool is_observations(const fs::path& file) {
  return kind_of(file) == ppp::FileKind::observation;
}

// A receiver's stream counts as its observations only if it is named: in a folder it can be that of
// the satellites' messages.
bool is_receivers_file(const fs::path& file) {
  const ppp::FileKind kind = kind_of(file);
  return kind == ppp::FileKind::observation || kind == ppp::FileKind::ubx ||
         kind == ppp::FileKind::rtcm3;
}

fs::path observations_of(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  std::vector<fs::path> found;
  for (const fs::path& file : ppp::files_in(path)) {
    if (is_observations(file)) found.push_back(file);
  }
  if (found.size() == 1) return found.front();
  std::string names;
  for (const fs::path& file : found) names += "\n  " + file.string();
  throw std::runtime_error("the folder '" + path.string() + "' contains the observations of " +
                           std::to_string(found.size()) +
                           " receivers; name the file to replay instead:" + names);
}

}  // namespace

bool is_gnss_drive(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return is_receivers_file(path);
  if (fs::is_directory(path / "image_00", ignored)) return false;
  const std::vector<fs::path> files = ppp::files_in(path);
  return std::any_of(files.begin(), files.end(), is_observations);
}

GnssDrive::GnssDrive(const fs::path& path, const VehicleConfig& config)
    : latency_(from_seconds(config.ppp.latency)) {
  const fs::path observations = observations_of(path);
  ppp::read_into(observations, files_);
  read_products(observations, config);
}

GnssDrive::GnssDrive(const fs::path& recording, const std::string& observations,
                     const VehicleConfig& config)
    : latency_(from_seconds(config.ppp.latency)) {
  ppp::parse_into(observations, recording.string(), files_);
  read_products(recording, config);
}

void GnssDrive::read_products(const fs::path& observations, const VehicleConfig& config) {
  const fs::path beside = fs::absolute(observations).parent_path();
  if (config.ppp.products.empty()) ppp::read_products(beside, files_, observations);
  for (const fs::path product : config.ppp.products) ppp::read_products(product, files_);
  setup_ = std::make_unique<ppp::PppSetup>(files_, setup_options(config.ppp));
}

Time GnssDrive::first_stamp() const {
  return ppp::to_utc(setup_->observations().epochs.front().time);
}

Time GnssDrive::last_stamp() const {
  return ppp::to_utc(setup_->observations().epochs.back().time);
}

std::unique_ptr<sensors::Source<GnssEpoch>> GnssDrive::epochs(
    std::shared_ptr<const GnssDrive> drive) {
  return sensors::made<GnssEpoch>([drive = std::move(drive), at = std::size_t{0},
                                   last = Time::min()](GnssEpoch& sample,
                                                       sensors::SourceReport& report) mutable {
    const ppp::Observations& o = drive->setup().observations();
    if (at == 0) {
      report.refused = static_cast<std::uint64_t>(o.refused);
      for (const std::string& why : o.refusals) report.refusals.push_back({o.file, 0, why});
    }
    for (; at < o.epochs.size(); ++at) {
      const Time stamp = ppp::to_utc(o.epochs[at].time);
      if (stamp <= last) {
        report.refuse(
            {o.file, 0,
             "epoch " + format_gps_time(o.epochs[at].time) + " is not later than the one before"});
        continue;
      }
      last = sample.stamp = stamp;
      sample.available = stamp + drive->latency_;
      sample.sequence = at;
      sample.epoch = o.epochs[at++];
      return true;
    }
    return false;
  });
}

void use_observations(Sensors& s, const std::shared_ptr<const GnssDrive>& drive) {
  s.gnss = nullptr;
  s.epochs = GnssDrive::epochs(drive);
  s.ppp = {drive, &drive->setup()};  // this pointer keeps the drive alive
}

}  // namespace maploop::vehicle
