// Lists the examples with which the help of each command begins.
#pragma once

#include <string_view>
#include <vector>

namespace maploop::tools {

// Returns what follows the program's name in the examples of a command. The command is given as its
// words without that name, such as "log info", or "" for the program itself. An unknown command has
// none.
std::vector<std::string_view> examples(std::string_view command);

}  // namespace maploop::tools
