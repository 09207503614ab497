// maploop gnss: what is in GNSS files.
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "tools/command/commands.h"
#include "tools/gnss/info.h"
#include "tools/gnss/reach.h"

namespace maploop::tools {
namespace {

// Every file is tried; one that cannot be read makes the exit status 1.
int gnss_info(const std::vector<std::filesystem::path>& files) {
  int status = 1;  // unless a file is read, and none cannot be
  bool failed = false;
  ppp::GnssFiles all;
  for (const auto& file : files) {
    try {
      if (is_regular_file(file) && file_size(file) == 0) {
        std::cout << file.string() << ": empty\n";
        continue;
      }
      ppp::GnssFiles one;
      std::cout << gnss::info(file, one);
      append(all, std::move(one));
      status = 0;
    } catch (const std::runtime_error& error) {
      std::cerr << "maploop: " << error.what() << '\n';
      failed = true;
    }
  }
  if (files.size() > 1) std::cout << gnss::reach(all);
  return failed ? 1 : status;
}

}  // namespace

void add_gnss(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand("gnss", "Look into GNSS files");
  sub->require_subcommand(1);
  CLI::App* info = sub->add_subcommand(
      "info",
      "What is in a file: RINEX observations, navigation and clocks, compact RINEX, SP3, ANTEX, "
      "Bias-SINEX, DCB, ERP, BLQ, IONEX, ORBEX, UBX (u-blox), RTCM 3, plain or .gz, told apart by "
      "content; and how accurate positions become with all of them");
  const auto files = std::make_shared<std::vector<std::filesystem::path>>();
  info->add_option("FILE", *files, "Files to look into")->required();
  info->callback([files, &command] { command = [files] { return gnss_info(*files); }; });
}

}  // namespace maploop::tools
