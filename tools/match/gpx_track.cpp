#include <expat.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "msgs/trimmed.h"
#include "tools/evaluate/text_lines.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

double number(std::string_view text) {
  return evaluation::number_of<double>(text).value_or(mapmatch::unknown);
}

// Returns the name without its namespace.
std::string_view local(const char* name) {
  const std::string_view whole = name;
  return whole.substr(whole.rfind(':') + 1);
}

// Takes the track points of a file from the elements that Expat finds.
class GpxReader {
 public:
  GpxReader(std::string_view name, const TrackOptions& options)
      : name_(name), options_(options), parser_(XML_ParserCreate(nullptr), &XML_ParserFree) {
    if (parser_ == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* element, const char** attributes) {
          static_cast<GpxReader*>(self)->guard(&GpxReader::begin, element, attributes);
        },
        [](void* self, const char* element) {
          static_cast<GpxReader*>(self)->guard(&GpxReader::end, element);
        });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int size) {
      static_cast<GpxReader*>(self)->text_.append(text, static_cast<std::size_t>(size));
    });
  }

  Track read(std::string_view text) {
    const auto status =
        XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
    if (thrown_) std::rethrow_exception(thrown_);
    if (status == XML_STATUS_ERROR) refuse(XML_GetErrorCode(parser_.get()));
    return in_order();
  }

 private:
  // Expat is C: nothing may be thrown through it.
  template <class... Arguments>
  void guard(void (GpxReader::*handle)(Arguments...), Arguments... arguments) {
    try {
      (this->*handle)(arguments...);
    } catch (...) {
      thrown_ = std::current_exception();
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": track point " + std::to_string(points_) + ": " + what);
  }

  [[noreturn]] void refuse(XML_Error error) const {
    const bool cut = error == XML_ERROR_NO_ELEMENTS || error == XML_ERROR_UNCLOSED_TOKEN ||
                     error == XML_ERROR_PARTIAL_CHAR || error == XML_ERROR_UNCLOSED_CDATA_SECTION;
    throw std::runtime_error(name_ + ':' + std::to_string(XML_GetCurrentLineNumber(parser_.get())) +
                             ": " +
                             (cut ? "it ends within an element, after " + std::to_string(points_) +
                                        " track points: was it cut? Close its elements to use them"
                                  : "it is not XML: " + std::string(XML_ErrorString(error))));
  }

  void begin(const char* element, const char** attributes) {
    const std::string_view tag = local(element);
    text_.clear();
    if (tag == "trkseg") segments_.emplace_back();
    if (tag != "trkpt") return;
    ++points_;
    if (in_point_) fail("the point before it does not end");
    in_point_ = true;
    fix_ = {};
    time_.clear();
    double latitude = mapmatch::unknown, longitude = mapmatch::unknown;
    for (; *attributes != nullptr; attributes += 2) {
      if (local(attributes[0]) == "lat") latitude = number(attributes[1]);
      if (local(attributes[0]) == "lon") longitude = number(attributes[1]);
    }
    if (std::isnan(latitude) || std::isnan(longitude)) fail("no lat and lon");
    fix_.position = {radians(latitude), radians(longitude), 0.0};
    fix_.covariance = options_.sigma * options_.sigma * Eigen::Matrix2d::Identity();
  }

  void end(const char* element) {
    if (!in_point_) return;
    const std::string_view tag = local(element);
    const std::string_view text = trimmed(text_);
    if (tag == "time") time_ = text;
    if (tag == "speed") fix_.speed = number(text);
    if (tag == "course") fix_.azimuth = radians(number(text));
    if (tag == "hdop") fix_.hdop = number(text);
    text_.clear();
    if (tag != "trkpt") return;
    in_point_ = false;
    if (time_.empty()) fail("no time, which matching needs");
    const auto stamp = parse_track_time(time_);
    if (!stamp) fail("the time '" + time_ + "' cannot be read");
    fix_.stamp = *stamp;
    if (segments_.empty()) segments_.emplace_back();
    keep(fix_, name_, segments_.back());
  }

  // A file may have its segments, such as the drives of a week, in any order.
  Track in_order() {
    std::erase_if(segments_, [](const Track& segment) { return segment.empty(); });
    std::stable_sort(segments_.begin(), segments_.end(), [](const Track& a, const Track& b) {
      return a.front().stamp < b.front().stamp;
    });
    Track track;
    for (const Track& segment : segments_) {
      if (!track.empty() && segment.front().stamp < track.back().stamp) {
        throw std::runtime_error(name_ +
                                 ": two of its tracks or segments overlap in time; give the tracks "
                                 "of several vehicles as files of their own");
      }
      for (const mapmatch::VehicleFix& fix : segment) keep(fix, name_, track);
    }
    return track;
  }

  std::string name_;
  const TrackOptions& options_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::exception_ptr thrown_;
  std::vector<Track> segments_;
  std::size_t points_ = 0;
  bool in_point_ = false;
  mapmatch::VehicleFix fix_;
  std::string time_, text_;
};

}  // namespace

Track parse_gpx_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  return GpxReader(name, options).read(text);
}

}  // namespace maploop::match
