#include "tools/command/recorded_drive_options.h"

#include "tools/command/option_checks.h"

namespace maploop::tools {

void add_recorded_drive_options(CLI::App& command, RecordedDriveOptions& options, const char* map) {
  command.add_option("MAP", options.map, map)->required();
  command.add_option("DATA", options.data, "Folder with oxts/NN.csv.gz and labels/NN.csv.gz")
      ->required()
      ->check(existing_folder());
  command.add_option("--sequences", options.sequences, "Which of them")->delimiter(',');
  command.add_option("--seeds", options.seeds, "Realizations of each noise")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  add_matcher_options(command, options);
}

}  // namespace maploop::tools
