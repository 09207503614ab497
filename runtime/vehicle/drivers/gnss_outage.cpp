#include "runtime/vehicle/drivers/gnss_outage.h"

#include <algorithm>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sensors/number.h"

namespace maploop::vehicle {
namespace {

[[noreturn]] void refuse(std::string_view part, const std::string& why) {
  throw std::invalid_argument("outage '" + std::string(part) + "': " + why +
                              "; write START:LENGTH in seconds, where LENGTH may be 'end', "
                              "repeated:START:LENGTH or random:COUNT:LENGTH");
}

double number(std::string_view part, std::string_view text, const char* what) {
  const auto value = sensors::parse_number<double>(text);
  if (!value || *value < 0.0 || *value > 1e6) {
    refuse(part, "'" + std::string(text) + "' is not " + what + " from 0 to 1e6");
  }
  return *value;
}

double seconds(std::string_view part, std::string_view text) {
  return number(part, text, "a number of seconds");
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// A Part is one element of the list; `count` is 0 if its start is given, that of the first one if
// it is repeated.
struct Part {
  std::string_view text;
  double start = 0.0;
  double length = 0.0;
  bool to_end = false;
  int count = 0;
  bool repeated = false;
};

Part parse_part(std::string_view text) {
  const std::vector<std::string_view> words = split(text, ':');
  Part part;
  part.text = text;
  if (words.size() == 3 && words[0] == "random") {
    part.count = static_cast<int>(number(text, words[1], "a count"));
    if (part.count < 1 || part.count > 1000) refuse(text, "the count must be 1 to 1000");
  } else if (words.size() == 3 && words[0] == "repeated") {
    part.repeated = true;
    part.start = seconds(text, words[1]);
  } else if (words.size() == 2) {
    part.start = seconds(text, words[0]);
  } else {
    refuse(text, "has an unknown form");
  }
  part.to_end = words.back() == "end" && part.count == 0 && !part.repeated;
  if (!part.to_end) {
    part.length = seconds(text, words.back());
    if (part.length == 0.0) refuse(text, "the length must not be zero");
  }
  return part;
}

constexpr double settled = 60.0;  // s; by then the filter has estimated its sensors' errors

std::string too_short(const Part& part) {
  std::ostringstream text;
  text << "the drive is too short for " << part.count << " outages of " << part.length
       << " s after its first " << settled << " s";
  return text.str();
}

bool overlaps(const std::vector<GnssOutage>& outages, const GnssOutage& one) {
  return std::any_of(outages.begin(), outages.end(), [&](const GnssOutage& other) {
    return one.begin < other.end && other.begin < one.end;
  });
}

void add_random(const Part& part, Time first, Time last, std::int64_t seed,
                std::vector<GnssOutage>& outages) {
  const double latest = to_seconds(last - first) - part.length;
  if (latest <= settled) refuse(part.text, too_short(part));
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  constexpr int tries = 1000;
  int left = part.count;
  for (int i = 0; i < tries && left > 0; ++i) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    const Time begin = first + from_seconds(settled + share * (latest - settled));
    const GnssOutage one{begin, begin + from_seconds(part.length)};
    if (overlaps(outages, one)) continue;
    outages.push_back(one);
    --left;
  }
  if (left > 0) refuse(part.text, too_short(part));
}

// Between two of them the filter has the time to settle again.
void add_repeated(const Part& part, Time first, Time last, std::vector<GnssOutage>& outages) {
  const double duration = to_seconds(last - first);
  if (part.start + part.length >= duration)
    refuse(part.text, "the drive ends before the first of them does");
  for (double start = part.start; start + part.length < duration; start += part.length + settled) {
    const Time begin = first + from_seconds(start);
    outages.push_back({begin, begin + from_seconds(part.length)});
  }
}

}  // namespace

std::vector<GnssOutage> parse_outages(const std::string& text, Time first, Time last,
                                      std::int64_t seed) {
  std::vector<GnssOutage> outages;
  for (const std::string_view word : split(text, ',')) {
    const Part part = parse_part(word);
    if (part.count > 0) {
      add_random(part, first, last, seed, outages);
    } else if (part.repeated) {
      add_repeated(part, first, last, outages);
    } else {
      const Time begin = first + from_seconds(part.start);
      outages.push_back({begin, part.to_end ? Time::max() : begin + from_seconds(part.length)});
    }
  }
  std::sort(outages.begin(), outages.end(),
            [](const GnssOutage& a, const GnssOutage& b) { return a.begin < b.begin; });
  return outages;
}

std::string check_outages(const std::string& text) {
  try {
    for (const std::string_view word : split(text, ',')) parse_part(word);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

}  // namespace maploop::vehicle
