// Finds the files that are installed with maploop.
#pragma once

#include <filesystem>

namespace maploop {

// Returns share/maploop: the nearest above the program, or the Python module, that this code is
// part of, both when installed and in a build folder. If there is none, it is the one that would be
// beside the folder of the program or module.
std::filesystem::path shared_folder();

}  // namespace maploop
