// maploop experiment rules: what each fuzzy rule changes on recorded drives, and weights for them.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "mapmatch/network_file.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "tools/command/recorded_drive_options.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/table.h"
#include "tools/match/recorded_drives.h"

namespace maploop::tools {
namespace {

struct RulesExperimentOptions : RecordedDriveOptions {
  std::filesystem::path learn;
};

// The rule bases that drives without visual odometry use.
struct NamedBase {
  const char* file;
  mapmatch::FuzzySystem mapmatch::RuleBases::*system;
};
constexpr std::array named_bases{
    NamedBase{"initial_matching.fll", &mapmatch::RuleBases::initial},
    NamedBase{"along_link.fll", &mapmatch::RuleBases::along},
    NamedBase{"junction.fll", &mapmatch::RuleBases::junction},
};

// The drives with made errors, and how well rules match them.
class Trial {
 public:
  explicit Trial(const RulesExperimentOptions& options)
      : network_(mapmatch::open_network(options.map)), parameters_(options.parameters()) {
    const std::vector<match::InputCondition> conditions = match::input_conditions();
    tracks_.resize(conditions.size());
    drives_.reserve(options.sequences.size());
    for (const std::string& name : options.sequences) {
      std::cerr << "\rsequence " << name << std::flush;
      drives_.push_back(match::read_recorded_drive(options.data, name));
      for (std::size_t c = 0; c < conditions.size(); ++c) {
        for (match::NoisyTrack& noisy : conditions[c].realizations(drives_.back(), options.seeds))
          tracks_[c].push_back({std::move(noisy), drives_.size() - 1});
      }
    }
    std::cerr << '\n';
  }

  // Returns the share of fixes on the right way, as the mean over the conditions, in percent.
  double share(const mapmatch::RuleBases& rules, bool paths) const {
    mapmatch::MatchParameters parameters = parameters_;
    parameters.paths = paths;
    double sum = 0.0;
    for (const auto& condition : tracks_) {
      match::MatchScore score;
      for (const auto& [noisy, drive] : condition) {
        mapmatch::Matcher matcher(network_, rules, parameters);
        score.add(match::match_track(matcher, noisy.track), noisy.rows, drives_[drive].labels);
      }
      sum += score.all.share();
    }
    return 100.0 * sum / static_cast<double>(tracks_.size());
  }

 private:
  struct TrackOfDrive {
    match::NoisyTrack noisy;
    std::size_t drive;
  };
  mapmatch::RoadNetwork network_;
  mapmatch::MatchParameters parameters_;
  std::vector<match::RecordedDrive> drives_;
  std::vector<std::vector<TrackOfDrive>> tracks_;  // by condition
};

mapmatch::RuleBases with_weight(const mapmatch::RuleBases& bases, const NamedBase& base,
                                std::size_t rule, double weight) {
  mapmatch::RuleBases changed = bases;
  const mapmatch::FuzzySystem& system = bases.*base.system;
  std::vector<mapmatch::FuzzyRule> rules = system.rules();
  rules[rule].weight = weight;
  changed.*base.system =
      mapmatch::FuzzySystem(system.variables(), std::move(rules), system.centroid());
  return changed;
}

// Takes each rule in turn and keeps the weight that matches best with the rules alone, until a
// round changes none. In the end each rule gets back the weight 1 if that costs next to nothing.
void learn(const Trial& trial, mapmatch::RuleBases& rules) {
  constexpr std::array weights{0.0, 0.25, 0.5, 2.0, 4.0, 1.0};
  constexpr double worth = 0.02;  // percent that a weight other than 1 must gain
  constexpr int rounds = 4;
  double best = trial.share(rules, false);
  bool changed = true;
  const auto take = [&](const NamedBase& base, std::size_t rule, double weight, double least) {
    if ((rules.*base.system).rules()[rule].weight == weight) return;
    mapmatch::RuleBases tried = with_weight(rules, base, rule, weight);
    const double share = trial.share(tried, false);
    if (share < best + least) return;
    best = share;
    rules = std::move(tried);
    changed = true;
  };
  const auto each_rule = [&](const std::string& title, const auto& function) {
    for (const NamedBase& base : named_bases) {
      const std::size_t count = (rules.*base.system).rules().size();
      for (std::size_t r = 0; r < count; ++r) function(base, r);
      std::cerr << title << ", " << base.file << ": " << experiments::number(best, 3) << " %\n";
    }
  };
  for (int round = 1; round <= rounds && changed; ++round) {
    changed = false;
    each_rule("round " + std::to_string(round), [&](const NamedBase& base, std::size_t r) {
      for (const double weight : weights) take(base, r, weight, worth);
    });
  }
  each_rule("weights of 1",
            [&](const NamedBase& base, std::size_t r) { take(base, r, 1.0, -0.1 * worth); });
}

// Writes the files of the folder `from` to the folder `to`, with the weights of the rules.
void write_rules(const mapmatch::RuleBases& rules, const std::filesystem::path& from,
                 const std::filesystem::path& to) {
  std::filesystem::copy_file(from / "along_link_visual.fll", to / "along_link_visual.fll",
                             std::filesystem::copy_options::overwrite_existing);
  for (const NamedBase& base : named_bases) {
    std::istringstream in(read_text(from / base.file, input_limits::settings));
    std::ofstream out(to / base.file);
    auto rule = (rules.*base.system).rules().begin();
    for (std::string line; std::getline(in, line);) {
      const std::size_t key = line.find_first_not_of(" \t");
      if (key != std::string::npos && line.compare(key, 4, "rule") == 0) {
        line = "  rule: " + rule->text.substr(0, rule->text.find(" with "));
        if (rule->weight != 1.0) line += " with " + fmt::format("{}", rule->weight);
        ++rule;
      }
      out << line << '\n';
    }
    if (!out.flush()) throw std::runtime_error((to / base.file).string() + ": cannot be written");
  }
}

int rules_experiment(const RulesExperimentOptions& options) {
  mapmatch::RuleBases rules = options.rule_bases();
  if (!options.learn.empty()) {
    std::filesystem::create_directories(options.learn);
    if (std::filesystem::equivalent(options.rules, options.learn)) {
      throw std::runtime_error("--learn " + options.learn.string() +
                               ": the rules are read from there; name another folder");
    }
  }
  const Trial trial(options);
  if (!options.learn.empty()) {
    learn(trial, rules);
    write_rules(rules, options.rules, options.learn);
  }
  using experiments::number;
  const double alone = trial.share(rules, false), beside = trial.share(rules, true);
  experiments::Table table{
      "Fixes on the right way in percent, mean of all conditions, and what is lost without each "
      "rule",
      {"file", "rule", "weight", "alone", "beside paths", "text"},
      {{"all", "", "", number(alone, 3), number(beside, 3), ""}}};
  for (const NamedBase& base : named_bases) {
    const auto& all = (rules.*base.system).rules();
    for (std::size_t r = 0; r < all.size(); ++r) {
      const mapmatch::RuleBases without = with_weight(rules, base, r, 0.0);
      table.rows.push_back({base.file, std::to_string(r + 1), number(all[r].weight, 2),
                            number(alone - trial.share(without, false), 3),
                            number(beside - trial.share(without, true), 3), all[r].text});
    }
  }
  std::cout << as_text(table);
  return 0;
}

}  // namespace

void add_rules_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<RulesExperimentOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "rules",
      "What each fuzzy rule changes in map matching, with the rules alone and beside the paths; "
      "can learn the weights of the rules");
  add_recorded_drive_options(*sub, *options, "OpenStreetMap file, or a network file");
  sub->add_option("--learn", options->learn,
                  "Choose the weights by these drives, and write the rule bases to this folder");
  sub->callback(
      [options, &command] { command = [options] { return rules_experiment(*options); }; });
}

}  // namespace maploop::tools
