#include "tools/match/track_matching.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <map>
#include <stdexcept>
#include <thread>

#include "mapmatch/match_history.h"
#include "msgs/median.h"
#include "tools/command/progress.h"
#include "tools/match/driven_route.h"
#include "tools/match/match_summary.h"

namespace maploop::match {
namespace {

// This is printed of one track: what became of its fixes, and how long its route is.
struct TrackResult {
  MatchSummary counts;
  double kilometres = 0.0;
  std::string error;
};

double kilometres_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  double metres = 0.0;
  for (const DrivenRoute::Piece& piece : driven_route(track, network).pieces)
    for (const RouteStep& step : piece) metres += step.length();
  return metres / 1000.0;
}

std::string line(const std::string& name, const TrackResult& r) {
  const auto percent = [&](std::size_t count) {
    return r.counts.fixes > 0
               ? 100.0 * static_cast<double>(count) / static_cast<double>(r.counts.fixes)
               : 0.0;
  };
  return fmt::format("{:<30} {:>8} {:>8.2f} {:>8.2f} {:>8.2f} {:>9.2f}\n",
                     name.size() <= 30 ? name : "..." + name.substr(name.size() - 27),
                     r.counts.fixes, percent(r.counts.matched), 100.0 * r.counts.doubtful_share(),
                     percent(r.counts.off_road), r.kilometres);
}

// Returns the name of a track without its endings: "01" of "01.csv.gz".
std::string name_of(const std::filesystem::path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).stem().string();
}

void refuse_equal_names(std::span<const std::filesystem::path> files) {
  std::map<std::string, std::filesystem::path> names;
  for (const std::filesystem::path& file : files) {
    const auto [other, is_new] = names.emplace(name_of(file), file);
    if (!is_new) {
      throw std::runtime_error(other->second.string() + " and " + file.string() +
                               " would have the same files of results: match them apart");
    }
  }
}

std::filesystem::path file_of(const TrackOutput& output, const std::filesystem::path& track) {
  return output.folder / (name_of(track) + output.ending);
}

void refuse_to_replace(std::span<const std::filesystem::path> tracks, const TrackOutput& output) {
  for (const std::filesystem::path& track : tracks) {
    std::error_code none;
    if (std::filesystem::equivalent(file_of(output, track), track, none)) {
      throw std::runtime_error("the results would replace the track " + track.string() +
                               ": give another folder than " + output.folder.string());
    }
  }
}

// Returns the time between fixes that does not interrupt a track whose fixes are this rare, s.
double usual_gap(const Track& fixes) {
  constexpr double longest = 300.0;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < fixes.size(); ++i)
    intervals.push_back(to_seconds(fixes[i].stamp - fixes[i - 1].stamp));
  return intervals.empty() ? 0.0 : std::min(3.0 * median(intervals), longest);
}

}  // namespace

MatchedTrack TrackMatching::match(Track fixes, std::string name,
                                  std::vector<double>* microseconds) const {
  mapmatch::MatchParameters of_track = parameters;
  of_track.max_gap = std::max(parameters.max_gap, usual_gap(fixes));
  MatchedTrack track{std::move(fixes), {}, std::move(name), of_track.lane_sigma, of_track.max_gap};
  mapmatch::Matcher matcher(network, rules, of_track);
  mapmatch::MatchHistory history(network);
  track.results.reserve(track.fixes.size());
  for (const mapmatch::VehicleFix& fix : track.fixes) {
    const auto start = std::chrono::steady_clock::now();
    const mapmatch::MatchResult& result = matcher.add(fix);
    if (microseconds != nullptr)
      microseconds->push_back(1e6 * to_seconds(std::chrono::steady_clock::now() - start));
    track.results.push_back(result);
    if (lag > Duration::zero()) history.add(result, matcher);
  }
  if (lag > Duration::zero()) track.results = history.judged_after(lag);
  return track;
}

void match_tracks(std::span<const std::filesystem::path> files,
                  const std::function<Track(const std::filesystem::path&)>& read,
                  const TrackMatching& matching, std::span<const TrackOutput> outputs) {
  if (!outputs.empty()) refuse_equal_names(files);
  for (const TrackOutput& output : outputs) refuse_to_replace(files, output);
  for (const TrackOutput& output : outputs) std::filesystem::create_directories(output.folder);
  std::vector<TrackResult> results(files.size());
  tools::Progress progress("tracks");
  std::atomic<std::size_t> done = 0;
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < files.size(); i = next++) {
      TrackResult& result = results[i];
      try {
        const std::filesystem::path& file = files[i];
        const MatchedTrack track = matching.match(read(file), file.filename().string(), nullptr);
        if (const auto why = why_unusable(track, matching.network))
          throw std::runtime_error(file.string() + ": " + *why);
        result.counts = summary(track, matching.network);
        result.kilometres = kilometres_of(track, matching.network);
        for (const TrackOutput& output : outputs) output.write(file_of(output, file), track);
      } catch (const std::exception& e) {
        result.error = e.what();
      }
      progress.at(static_cast<double>(++done), static_cast<double>(files.size()));
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t count =
        std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, files.size());
    threads.reserve(count);
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(work);
  }
  std::cout << "track                             fixes  road %  doubt %   off %  route km\n";
  TrackResult all;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const TrackResult& r = results[i];
    if (!r.error.empty()) {
      ++failed;
      std::cerr << r.error << '\n';
      continue;
    }
    std::cout << line(files[i].filename().string(), r);
    all.counts.fixes += r.counts.fixes;
    all.counts.matched += r.counts.matched;
    all.counts.doubtful += r.counts.doubtful;
    all.counts.off_road += r.counts.off_road;
    all.kilometres += r.kilometres;
  }
  std::cout << line(fmt::format("all {} tracks", files.size() - failed), all)
            << "road: matched; doubt: of these with P below 0.9; off: in the map, but on no road\n";
  if (failed > 0) {
    throw std::runtime_error(fmt::format(
        "{} of {} tracks could not be matched; the reason of each is above", failed, files.size()));
  }
}

}  // namespace maploop::match
