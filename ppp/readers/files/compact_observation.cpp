#include "ppp/readers/files/compact_observation.h"

#include <array>
#include <charconv>
#include <map>

#include "ppp/readers/files/refused_epochs.h"
#include "ppp/readers/streams/epoch_builder.h"
#include "ppp/readers/streams/epoch_sequence.h"

namespace maploop::ppp {
namespace {

// Applies a text given as its difference to the previous one: a blank keeps a character, '&' blanks
// it.
void apply_difference(std::string& text, std::string_view difference) {
  if (text.size() < difference.size()) text.resize(difference.size(), ' ');
  for (std::size_t i = 0; i < difference.size(); ++i) {
    if (difference[i] == '&') {
      text[i] = ' ';
    } else if (difference[i] != ' ') {
      text[i] = difference[i];
    }
  }
}

// An Arc is a sequence of numbers given as differences in time, whose order grows up to `order`.
class Arc {
 public:
  static constexpr int highest_order = 9;

  void start(int order, std::int64_t value) {
    order_ = order;
    held_ = 0;
    differences_[0] = value;
  }
  bool running() const { return order_ >= 0; }
  void end() { order_ = -1; }

  // Returns false if the value exceeds 64 bits.
  bool next(std::int64_t difference) {
    if (held_ < order_) ++held_;
    differences_[static_cast<std::size_t>(held_)] = difference;
    for (auto k = static_cast<std::size_t>(held_); k > 0; --k) {
      if (__builtin_add_overflow(differences_[k - 1], differences_[k], &differences_[k - 1])) {
        return false;
      }
    }
    return true;
  }
  std::int64_t value() const { return differences_[0]; }

 private:
  int order_ = -1, held_ = 0;
  std::array<std::int64_t, highest_order + 1> differences_{};
};

struct SatelliteArcs {
  std::vector<Arc> arcs;
  std::string flags;
  int epoch = -1;  // the last epoch that contained it
};

class CompactReader {
 public:
  CompactReader(Lines& lines, Observations& result) : lines_(lines), result_(result) {
    lines.next();
    in_force_ = read_header();
    result.header = in_force_.header;
  }

  void read() {
    read_epochs(lines_, result_, {[this] { return read_part(); }, [this] { return resumes(); }});
    sequence_.finish();
  }

 private:
  // Reads from the current line on.
  HeaderInForce read_header() {
    const double version = lines_.number(0, 20, "version of compact RINEX");
    if (version != 1.0 && version != 3.0 && version != 3.1)
      lines_.fail("unknown version; compact RINEX 1.0, 3.0 and 3.1 are supported");
    if (!lines_.next() || !lines_.next()) lines_.fail("the file ends inside its header");
    HeaderInForce header = read_observation_header(lines_);
    if (header.version3() != (version >= 3.0)) {
      lines_.fail(
          "compact RINEX 1 must contain RINEX 2, and compact RINEX 3 must contain RINEX 3 or 4");
    }
    return header;
  }

  // Reads an epoch, or the header of a second file that was appended to this one.
  bool read_part() {
    if (!is_compact(lines_.line())) return read_epoch();
    forget_epochs();
    columns_known_ = false;
    in_force_ = read_header();
    columns_known_ = true;
    take_event(in_force_, lines_, result_);
    return true;
  }

  bool is_initial(std::string_view line) const {
    return !line.empty() && line[0] == (in_force_.version3() ? '>' : '&');
  }

  // Returns whether an epoch that refers to none before begins here.
  bool resumes() {
    if (!columns_known_ || !(is_initial(lines_.line()) || is_compact(lines_.line()))) return false;
    forget_epochs();
    return true;
  }

  void forget_epochs() {
    epoch_line_.clear();
    clock_.end();
    satellites_state_.clear();
  }

  bool read_epoch() {
    if (!lines_.whole()) return false;
    const bool three = in_force_.version3();
    auto line = lines_.line();
    if (is_initial(line)) {
      epoch_line_.assign(line);
      if (!three) epoch_line_[0] = ' ';
    } else if (epoch_line_.empty()) {
      lines_.fail("the first epoch line must be complete, not a difference");
    } else {
      apply_difference(epoch_line_, line);
    }
    const std::string_view text = epoch_line_;
    const auto flag = parse_integer(columns(text, three ? 31 : 28, 1));
    const auto count = parse_integer(columns(text, three ? 32 : 29, 3));
    if (!flag || *flag < 0 || *flag > 5) lines_.fail("an epoch flag must be 0 to 5");
    if (!count || *count < 0 || *count > 200)
      lines_.fail("a number of satellites must be 0 to 200");
    if (*flag > 1) return read_event(*count);

    Epoch epoch;
    epoch.time =
        parse_stamp(lines_, three ? columns(text, 2, 27) : columns(text, 0, 26)) + in_force_.to_gps;
    epoch.power_failure = *flag == 1;
    list_satellites(columns(text, three ? 41 : 32, text.size()), *count);
    if (!lines_.next() || !lines_.whole()) return false;
    read_clock_offset(three ? 1e-12 : 1e-9, epoch);
    ++epoch_number_;
    for (const Satellite satellite : satellites_) {
      if (!lines_.next() || !lines_.whole()) return false;
      read_satellite(satellite, epoch);
    }
    sequence_.add(epoch);
    return true;
  }

  bool read_event(int count) {
    columns_known_ = false;
    for (const int last = lines_.line_number() + count; lines_.line_number() < last;) {
      if (!lines_.next() || !lines_.whole()) return false;
      apply_header_record(lines_, in_force_);
    }
    columns_known_ = true;
    take_event(in_force_, lines_, result_);
    epoch_line_.clear();  // the next epoch line is complete again
    return true;
  }

  void list_satellites(std::string_view names, int count) {
    satellites_.clear();
    for (int i = 0; i < count; ++i) {
      const auto name = columns(names, 3 * static_cast<std::size_t>(i), 3);
      const auto satellite = parse_satellite(name);
      if (!satellite)
        lines_.fail("'" + std::string(name) + "' is not a satellite; expected e.g. G05");
      satellites_.push_back(*satellite);
    }
  }

  std::int64_t integer(std::string_view text) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
      lines_.fail("'" + std::string(text) +
                  "' is not a difference: a whole number of at most 64 bits");
    }
    return value;
  }

  // "3&24178026635" starts an arc of third order; "-12" continues one.
  void advance(Arc& arc, std::string_view field) {
    if (field.size() > 2 && field[1] == '&') {
      if (field[0] < '0' || field[0] > '9') lines_.fail("the order of an arc must be 0 to 9");
      arc.start(field[0] - '0', integer(field.substr(2)));
    } else if (!arc.running()) {
      lines_.fail("'" + std::string(field) + "' continues no arc; an arc starts with ORDER&VALUE");
    } else if (!arc.next(integer(field))) {
      lines_.fail("'" + std::string(field) + "' makes the value exceed 64 bits");
    }
  }

  void read_clock_offset(double unit, Epoch& epoch) {
    const auto field = trimmed(lines_.line());
    if (field.empty()) {
      clock_.end();
      return;
    }
    advance(clock_, field);
    epoch.clock_offset = static_cast<double>(clock_.value()) * unit;
  }

  void read_satellite(Satellite satellite, Epoch& epoch) {
    const auto types = result_.header.types[static_cast<std::size_t>(satellite.system)].size();
    SatelliteArcs& state = satellites_state_[satellite];
    if (state.epoch != epoch_number_ - 1 || state.arcs.size() != types) {
      state.arcs.assign(types, {});
      state.flags.clear();
    }
    state.epoch = epoch_number_;
    values_.assign(types, {});
    auto line = lines_.line();
    for (std::size_t k = 0; k < types; ++k) {
      const auto end = std::min(line.find(' '), line.size());
      const auto field = line.substr(0, end);
      if (field.empty()) {
        state.arcs[k].end();
      } else {
        advance(state.arcs[k], field);
        values_[k].value = static_cast<double>(state.arcs[k].value()) / 1000.0;
      }
      line = end < line.size() ? line.substr(end + 1) : std::string_view{};
    }
    apply_difference(state.flags, line);
    state.flags.resize(2 * types, ' ');
    for (std::size_t k = 0; k < types; ++k) values_[k].lli = state.flags[2 * k];
    append_satellite(result_, lines_, satellite, values_, epoch);
  }

  Lines& lines_;
  Observations& result_;
  EpochSequence sequence_{result_, lines_};
  HeaderInForce in_force_;
  bool columns_known_ = true;  // false while, and for ever if, records inside the file are not read
  std::string epoch_line_;
  Arc clock_;
  int epoch_number_ = 0;
  std::map<Satellite, SatelliteArcs> satellites_state_;
  std::vector<Satellite> satellites_;
  std::vector<Value> values_;
};

}  // namespace

bool is_compact(std::string_view first_line) {
  return trimmed(columns(first_line, 60, 20)) == "CRINEX VERS   / TYPE";
}

void read_compact(Lines& lines, Observations& result) {
  CompactReader(lines, result).read();
}

}  // namespace maploop::ppp
