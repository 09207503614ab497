// Relays messages from the bus to the browsers, and encodes their commands.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/vehicle/output/runs.h"
#include "tools/dashboard/live_channels.h"
#include "tools/dashboard/trail.h"

namespace maploop::dashboard {

// take() and pass_on() must be called on one thread; trail() may be called on any.
class Relay {
 public:
  // `channels` must outlive it.
  explicit Relay(LiveChannels& channels) : channels_(channels) {}

  // Takes a message of any channel; `sender` is the address of the program that sent it, empty if
  // unknown; `now` is on a steady clock. Channels of whole images and scans, commands to players,
  // and messages that are not of our types are left out; the latter are counted.
  void take(std::string_view sender, std::string_view channel, std::span<const std::uint8_t> data,
            Duration now);

  // Publishes for each run the newest message of each channel that had one since the last call.
  // The messages of a run are those of the program that announces it on RUN; of programs that have
  // announced none for a while, those of the run "others". On RUNS it publishes for every browser
  // the runs, if they have changed: [{"id", "what", "ended", "player": its state, or null}]; a run
  // that has ended is there until another one begins. The end of a run is published on VERDICT
  // immediately by take(): {"id", "what", "lines": three of text}.
  void pass_on(Duration now);

  std::string trail(const std::string& run) const;
  std::uint64_t not_understood() const { return not_understood_; }

 private:
  // A program that sends.
  struct Source {
    Duration since{}, heard{};
    std::string run;                                             // empty: not announced yet
    std::map<std::string, std::vector<std::uint8_t>> waiting{};  // by channel; empty: passed on
    Trail trail{};
  };
  struct ShownRun {
    std::string what;
    bool ended = false;
  };

  template <class Message>
  void add_to_trail(Source& source, std::span<const std::uint8_t> data);
  Source* source_of(std::string_view sender, Duration now);
  void pass_on(Source& source);
  void take_run(Source& source, std::span<const std::uint8_t> data, Duration now);
  void take_player(std::span<const std::uint8_t> data, Duration now);
  void begin(const std::string& id, const std::string& what);
  void update_runs(Duration now);
  void pass_on_runs(Duration now);

  LiveChannels& channels_;
  vehicle::RunsHeard runs_;
  std::map<std::string, ShownRun> shown_;       // by id
  std::map<std::string, std::string> players_;  // last states as JSON, by run
  std::string said_runs_;
  std::uint64_t not_understood_ = 0;
  mutable std::mutex sources_mutex_;                    // trail() is called on other threads
  std::map<std::string, Source, std::less<>> sources_;  // by sender
};

// Returns an encoded replay_control_t for the player of a run (its id). `kind` is the name of the
// command: pause, resume, step-sample, step-image, seek (s into the drive), speed, next-miss, quit.
// Returns nothing if there is no such command.
std::vector<std::uint8_t> encoded_command(const std::string& run, const std::string& kind,
                                          double value);

}  // namespace maploop::dashboard
