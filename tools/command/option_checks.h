// Checks of what a command line says, before any work is done.
#pragma once

#include <CLI/CLI.hpp>

namespace maploop::tools {

// A finite number from lowest to highest, both allowed.
CLI::Validator number_in(double lowest, double highest);
CLI::Validator positive_number();
CLI::Validator number_from_zero();
CLI::Validator finite_number();
CLI::Validator whole_number();  // from 0

// What is there, or is not, is no error of usage: these throw std::runtime_error.
CLI::Validator existing_file();
CLI::Validator existing_folder();
CLI::Validator existing_path();
// A file to be written at the end of the work: its folder is there, and it is no folder itself.
CLI::Validator writable_file();

}  // namespace maploop::tools
