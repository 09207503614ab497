#include "ppp/readers/files/observation.h"

#include "ppp/readers/files/compact_observation.h"
#include "ppp/readers/streams/epoch_builder.h"

namespace maploop::ppp {
namespace {

constexpr int max_satellites = 200;

// Reads the plain formats, one epoch at a time.
class PlainReader {
 public:
  PlainReader(Lines& lines, Observations& result) : lines_(lines), result_(result) {
    in_force_ = read_observation_header(lines);
    result.header = in_force_.header;
  }

  void read() {
    while (lines_.next()) {
      if (blank(lines_.line())) continue;
      const bool whole = in_force_.version3() ? read_epoch3() : read_epoch2();
      if (!whole) {
        refuse(result_, lines_, "the file ends inside an epoch, which is left out");
        return;
      }
    }
  }

 private:
  // Returns false if the file ended inside the epoch.
  bool read_epoch3() {
    if (lines_.line()[0] != '>') lines_.fail("an epoch must start with '>'");
    if (!lines_.whole() && lines_.line().size() < 35) return false;
    const int flag = lines_.integer(31, 1, "epoch flag");
    const int count = count_of(32, 3);
    if (flag > 1) return read_event(flag, count);
    Epoch epoch;
    epoch.time = parse_stamp(lines_, lines_.column(2, 27)) + in_force_.to_gps;
    epoch.power_failure = flag == 1;
    epoch.clock_offset = lines_.number_or(41, 15, 0.0, "clock offset");
    for (int i = 0; i < count; ++i) {
      if (!lines_.next()) return false;
      const auto satellite = satellite_at(0);
      const auto types = result_.header.types[static_cast<std::size_t>(satellite.system)].size();
      if (types == 0) {
        lines_.fail("the header has no observation types for " + to_string(satellite));
      }
      values_.resize(types);
      for (std::size_t k = 0; k < types; ++k) values_[k] = value_at(3 + 16 * k);
      if (!lines_.whole() && i + 1 == count) return false;
      append_satellite(result_, lines_, satellite, values_, epoch);
    }
    keep_epoch(result_, lines_, epoch);
    return true;
  }

  bool read_epoch2() {
    if (!lines_.whole() && lines_.line().size() < 32) return false;
    const int flag = lines_.integer(28, 1, "epoch flag");
    const int count = count_of(29, 3);
    if (flag > 1) return read_event(flag, count);
    Epoch epoch;
    epoch.time = parse_stamp(lines_, lines_.column(0, 26)) + in_force_.to_gps;
    epoch.power_failure = flag == 1;
    epoch.clock_offset = lines_.number_or(68, 12, 0.0, "clock offset");
    satellites_.clear();
    for (int i = 0; i < count; ++i) {
      if (i > 0 && i % 12 == 0 && !lines_.next()) return false;
      if (!lines_.whole() && lines_.line().size() < 35 + 3 * static_cast<std::size_t>(i % 12)) {
        return false;
      }
      satellites_.push_back(satellite_at(32 + 3 * static_cast<std::size_t>(i % 12)));
    }
    for (const Satellite satellite : satellites_) {
      const auto types = result_.header.types[static_cast<std::size_t>(satellite.system)].size();
      values_.resize(types);
      for (std::size_t k = 0; k < types; ++k) {
        if (k % 5 == 0 && !lines_.next()) return false;
        values_[k] = value_at(16 * (k % 5));
      }
      if (!lines_.whole()) return false;
      append_satellite(result_, lines_, satellite, values_, epoch);
    }
    keep_epoch(result_, lines_, epoch);
    return true;
  }

  // After flags 2 to 5 there are header records; after 6 there are records of cycle slips in the
  // form of observations.
  bool read_event(int flag, int count) {
    if (flag > 6) lines_.fail("an epoch flag must be 0 to 6");
    if (flag == 6) lines_.fail("records of cycle slips (epoch flag 6) are not supported");
    for (int i = 0; i < count; ++i) {
      if (!lines_.next()) return false;
      apply_header_record(lines_, in_force_);
    }
    take_event(in_force_, lines_, result_);
    return true;
  }

  int count_of(std::size_t first, std::size_t width) const {
    const int count = lines_.integer_or(first, width, 0, "number of satellites");
    if (count < 0 || count > max_satellites) lines_.fail("a number of satellites must be 0 to 200");
    return count;
  }

  Satellite satellite_at(std::size_t column) const {
    const auto satellite = parse_satellite(lines_.column(column, 3));
    if (!satellite) {
      lines_.fail("'" + std::string(lines_.column(column, 3)) +
                  "' is not a satellite; expected e.g. G05");
    }
    return *satellite;
  }

  Value value_at(std::size_t column) const {
    const auto text = lines_.column(column, 14);
    if (blank(text)) return {};
    const auto lli = lines_.column(column + 14, 1);
    return {lines_.number(column, 14, "observation"), lli.empty() ? ' ' : lli[0]};
  }

  Lines& lines_;
  Observations& result_;
  HeaderInForce in_force_;
  std::vector<Value> values_;
  std::vector<Satellite> satellites_;
};

}  // namespace

Observations parse_observations(std::string_view text, const std::string& file) {
  Observations result;
  result.file = file;
  Lines lines(text, file);
  if (is_compact(lines.peek())) {
    read_compact(lines, result);
  } else {
    PlainReader(lines, result).read();
  }
  return result;
}

}  // namespace maploop::ppp
