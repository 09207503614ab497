#include "tools/doctor/recording_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::tools {
namespace {

double seconds_of(const RecordingReport& report) {
  return to_seconds(report.last - report.first);
}

std::string when(const RecordingReport& report) {
  return fmt::format("begins at {} UTC, and takes {:.1f} s", format_time(report.first),
                     seconds_of(report));
}

// Draws a value of each part of the recording against the part's middle, joining parts of a slow
// sensor so that twenty samples are expected in each.
std::vector<web::Plot> time_lines(const RecordingReport& report) {
  web::Plot samples{"Samples that can be used", "s", "% of the sensor's rate"};
  web::Plot delay{"Delivery after the stamp, longest", "s", "ms"};
  const double part = seconds_of(report) / SampleTimes::parts;
  for (const SensorHealth& s : report.sensors) {
    if (s.samples == 0 || s.rate == 0.0) continue;
    web::Line& count = samples.lines.emplace_back(web::Line{s.name, {}, {}});
    web::Line& late = delay.lines.emplace_back(web::Line{s.name, {}, {}});
    constexpr double expected = 20.0;  // one more or less is 5 %
    const auto joined = std::clamp<std::size_t>(
        static_cast<std::size_t>(std::ceil(expected / (s.rate * part))), 1, SampleTimes::parts);
    for (std::size_t i = 0; i + joined <= SampleTimes::parts; i += joined) {
      std::uint32_t n = 0;
      double latest = 0.0;
      for (std::size_t k = i; k < i + joined; ++k) {
        n += s.times.samples[k];
        latest = std::max(latest, s.times.delay[k]);
      }
      const auto width = static_cast<double>(joined);
      const double middle = part * (static_cast<double>(i) + width / 2.0);
      count.add(middle, 100.0 * n / (s.rate * part * width));
      late.add(middle, n > 0 ? latest : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return {samples, delay};
}

}  // namespace

std::string to_text(const RecordingReport& report) {
  std::string text = report.name + ' ' + when(report) + "\n\n";
  text += web::heading_text(sensor_health_columns) + '\n';
  for (const SensorHealth& s : report.sensors)
    text += web::to_text(sensor_health_columns, s) + '\n';
  if (!report.offsets.empty()) text += '\n' + web::heading_text(time_offset_columns) + '\n';
  for (const TimeOffset& o : report.offsets) text += web::to_text(time_offset_columns, o) + '\n';
  text += '\n';
  for (const std::string& sentence : report.sentences) text += sentence + '\n';
  return text;
}

nlohmann::json to_json(const RecordingReport& report) {
  return {{"begins", format_time(report.first)},
          {"sensors", web::list(sensor_health_columns, report.sensors)},
          {"offsets", web::list(time_offset_columns, report.offsets)},
          {"sentences", report.sentences}};
}

std::string to_html(const RecordingReport& report) {
  web::Page page(report.name);
  page.add(web::paragraph("The recording " + when(report) + "."));
  for (const std::string& sentence : report.sentences) page.add(web::paragraph(sentence));
  page.add(web::table(sensor_health_columns, report.sensors));
  for (const web::Plot& plot : time_lines(report)) page.add(plot);
  if (!report.offsets.empty()) {
    page.add(web::heading("Stamps of one sensor against another's"))
        .add(web::table(time_offset_columns, report.offsets));
  }
  return page.text();
}

}  // namespace maploop::tools
