// What npm has made of src/. Where maploop was built without npm the scripts are empty.
#pragma once

#include <string_view>

namespace maploop::web {

// Of written pages.
std::string_view page_script();
std::string_view page_style();

// Of the live dashboard.
std::string_view dashboard_script();
std::string_view dashboard_style();

// Of the page of `maploop match`.
std::string_view match_script();
std::string_view match_style();

}  // namespace maploop::web
