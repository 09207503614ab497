#include "ppp/readers/files/observation.h"

#include "ppp/readers/files/compact_observation.h"
#include "ppp/readers/files/refused_epochs.h"
#include "ppp/readers/streams/epoch_builder.h"
#include "ppp/readers/streams/epoch_sequence.h"

namespace maploop::ppp {
namespace {

constexpr int max_satellites = 200;

// Returns whether a program has written what it could not represent as a number.
bool is_overflow(std::string_view text) {
  text = trimmed(text);
  return text.find_first_not_of('*') == std::string_view::npos || text == "nan" || text == "NaN" ||
         text == "-nan" || text == "inf" || text == "-inf";
}

bool begins_file(std::string_view line) {
  return header_label(line) == "RINEX VERSION / TYPE";
}

bool stands_between_epochs(std::string_view line) {
  return begins_file(line) || header_label(line) == "COMMENT";
}

// Returns whether a line of RINEX 2 looks like the first one of an epoch: a date, a flag and the
// first satellite in their columns, or the flag of an event, whose date may be blank.
bool begins_epoch2(std::string_view line) {
  const auto flag = parse_integer(columns(line, 28, 1));
  const auto count = parse_integer(columns(line, 29, 3));
  if (!flag || *flag > 6 || !count || *count < 0 || *count > max_satellites) return false;
  const bool event = *flag > 1 && *flag < 6;
  if (event && blank(columns(line, 0, 28))) return true;
  for (std::size_t i = 0; i < 5; ++i) {
    const bool number = parse_integer(columns(line, 1 + 3 * i, 2)).has_value();
    if (line[3 * i] != ' ' || !number) return false;
  }
  if (line[18] != '.') return false;
  return event || *count == 0 || parse_satellite(columns(line, 32, 3)).has_value();
}

// Reads the plain formats, one epoch at a time.
class PlainReader {
 public:
  PlainReader(Lines& lines, Observations& result) : lines_(lines), result_(result) {
    lines.next();
    in_force_ = read_observation_header(lines);
    result.header = in_force_.header;
  }

  void read() {
    read_epochs(lines_, result_, {[this] { return read_part(); }, [this] { return resumes(); }});
    sequence_.finish();
  }

 private:
  // Reads an epoch or what is between two. Returns false if the file ended inside the epoch.
  bool read_part() {
    const auto line = lines_.line();
    if (begins_file(line)) {
      read_next_header();
      return true;
    }
    if (blank(line) || stands_between_epochs(line)) return true;
    return in_force_.version3() ? read_epoch3() : read_epoch2();
  }

  bool resumes() const {
    if (!columns_known_) return false;
    const auto line = lines_.line();
    if (begins_file(line)) return true;
    return in_force_.version3() ? line.starts_with('>') : begins_epoch2(line);
  }

  // Reads the header of a second file that was appended to this one.
  void read_next_header() {
    columns_known_ = false;
    HeaderInForce next = read_observation_header(lines_);
    if (next.version3() != in_force_.version3()) {
      lines_.fail("RINEX 2 and RINEX 3 follow each other in one file");
    }
    in_force_ = std::move(next);
    columns_known_ = true;
    take_event(in_force_, lines_, result_);
  }

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
      values_.resize(types);
      for (std::size_t k = 0; k < types; ++k) values_[k] = value_at(3 + 16 * k);
      if (!lines_.whole() && i + 1 == count) return false;
      append_satellite(result_, lines_, satellite, values_, epoch);
    }
    expect_end_of_epoch3();
    sequence_.add(epoch);
    return true;
  }

  // An epoch with more lines than it says may contain those of another one, whose beginning is
  // lost.
  void expect_end_of_epoch3() {
    const auto next = trimmed(lines_.peek());
    if (next.empty() || next[0] == '>' || stands_between_epochs(lines_.peek())) return;
    lines_.next();
    lines_.fail("the epoch has more lines than satellites");
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
    sequence_.add(epoch);
    return true;
  }

  // After flags 2 to 5 there are header records; after 6 there are records of cycle slips in the
  // form of observations.
  bool read_event(int flag, int count) {
    if (flag > 6) lines_.fail("an epoch flag must be 0 to 6");
    if (flag == 6) lines_.fail("records of cycle slips (epoch flag 6) are not used");
    columns_known_ = false;
    bool whole = true;
    // A record may go on in further lines, which count.
    for (const int last = lines_.line_number() + count; whole && lines_.line_number() < last;) {
      if (!lines_.next()) return false;
      whole = !lines_.line().starts_with('>');
      if (whole) apply_header_record(lines_, in_force_);
    }
    columns_known_ = true;
    take_event(in_force_, lines_, result_);
    if (!whole) lines_.fail("an event has fewer lines than it says");
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
    if (is_overflow(text)) {
      refuse(result_, lines_, "'" + std::string(trimmed(text)) + "' is no value: it is missing");
      return {};
    }
    const auto lli = lines_.column(column + 14, 1);
    return {lines_.number(column, 14, "observation"), lli.empty() ? ' ' : lli[0]};
  }

  Lines& lines_;
  Observations& result_;
  EpochSequence sequence_{result_, lines_};
  HeaderInForce in_force_;
  bool columns_known_ = true;  // false while, and for ever if, records inside the file are not read
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
