// Load shedding decides how much of its images and scans a live vehicle uses when its computer is
// too slow for all of them.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::vehicle {

enum class Shed : std::uint8_t {
  nothing,       // an overloaded vehicle loses samples
  scans_first,   // scans are thinned before image pairs are left out
  images_first,  // the reverse
};
constexpr std::array<std::string_view, 3> names_of(Shed) {
  return {"nothing", "scans-first", "images-first"};
}

struct OverloadParameters {
  Shed shed = Shed::scans_first;
  double shed_at = 0.9;     // share of its deadline that a step may take
  double restore_at = 0.5;  // share below which there is room
};

// The levels, in the order in which they are taken: every second point of the scans, every second
// image pair; with images_first the reverse. (Every fourth point would save no more time.) Three of
// ten steps of the odometry that take too long lead to the next level, a hundred in a row with room
// to the one before. A level that had to be taken again soon is left only after twice as many, up
// to 3200, so that the levels do not alternate.
//
// The levels thin the samples themselves, before they are recorded and used: a log holds what was
// used, and its replay needs no levels. Any thread may call any member; each takes a lock for a
// few instructions.
class LoadShedding {
 public:
  // `scans`, `images`: whether there are such sensors.
  LoadShedding(const OverloadParameters& parameters, bool scans, bool images);

  // A step of the odometry took this share of its deadline, from its release to its result.
  void worked(double share);

  // Returns n where every n-th point of a scan, or image pair, is used.
  int points_one_of() const { return level().points; }
  int pairs_one_of() const { return level().pairs; }

  // Returns what is left out at present, as a sentence; empty: nothing.
  std::string sentence() const;

 private:
  struct Level {
    int points = 1, pairs = 1;
  };

  Level level() const;
  void go_to(std::size_t level);

  OverloadParameters parameters_;
  std::vector<Level> levels_;  // the first one leaves nothing out
  mutable std::mutex mutex_;   // protects what follows
  std::size_t level_ = 0;
  std::uint32_t recent_ = 0;  // the last ten steps, a bit for each that took too long
  int with_room_ = 0;         // steps in a row
  int patience_ = 0;          // of them before the level before is restored
  int since_restored_ = 0;    // steps
};

}  // namespace maploop::vehicle
