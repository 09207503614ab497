// The bundles that npm makes of src/. The scripts are empty if maploop was built without npm.
#pragma once

#include <string_view>

namespace maploop::web {

// For written pages.
std::string_view page_script();
std::string_view page_style();

// For the live dashboard.
std::string_view dashboard_script();
std::string_view dashboard_style();

}  // namespace maploop::web
