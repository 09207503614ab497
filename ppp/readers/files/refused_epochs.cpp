#include "ppp/readers/files/refused_epochs.h"

#include "ppp/readers/streams/epoch_builder.h"

namespace maploop::ppp {
namespace {

// Counts the lines of an observation file that cannot be read.
class RefusedLines {
 public:
  RefusedLines(const Lines& lines, Observations& result)
      : lines_(lines), result_(result), header_(lines.line_number()) {}

  // Refuses the lines [begin, end).
  void add(const std::string& reason, int begin, int end) {
    if (times_++ == 0) first_ = reason;
    count_ += end - begin;
    const std::string which = end - begin == 1 ? "this line is left out"
                                               : "lines " + std::to_string(begin) + " to " +
                                                     std::to_string(end - 1) + " are left out";
    refuse(result_, ReadError(reason + "; " + which));
    // Most files are judged at their end; one that is nothing but errors would take too long.
    constexpr int enough = 1000;
    if (times_ > enough && result_.epochs.empty()) judge();
  }

  // Throws if the file cannot be read on the whole.
  void judge() const {
    if (times_ == 0) return;
    const int all = lines_.line_number() - header_;
    if (!result_.epochs.empty() && 2LL * count_ <= all) return;
    throw ReadError(first_ + " (and so on: " + std::to_string(count_) + " of the " +
                    std::to_string(all) + " lines behind the header cannot be used)");
  }

 private:
  const Lines& lines_;
  Observations& result_;
  int header_;
  int times_ = 0, count_ = 0;
  std::string first_;
};

}  // namespace

void read_epochs(Lines& lines, Observations& result, const EpochReading& reading) {
  RefusedLines refused(lines, result);
  bool more = lines.next();
  while (more) {
    const int begin = lines.line_number();
    try {
      if (!reading.read()) {
        refuse(result, lines, "the file ends inside an epoch, which is left out");
        break;
      }
      more = lines.next();
    } catch (const ReadError& error) {
      // The line that cannot be read may be the first one of the next epoch.
      if (lines.line_number() == begin) more = lines.next();
      while (more && !reading.resumes()) more = lines.next();
      refused.add(error.what(), begin, lines.line_number() + (more ? 0 : 1));
    }
  }
  refused.judge();
}

}  // namespace maploop::ppp
