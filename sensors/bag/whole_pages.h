// This file hides from SQLite the part of a page with which a cut database ends: SQLite would take
// it for a page whose other bytes are zeros, and deliver them.
#pragma once

namespace maploop::sensors::bag {

// Returns the name by which sqlite3_open_v2 finds the file system that does so. Any thread may call
// it. Throws std::runtime_error.
const char* whole_pages();

}  // namespace maploop::sensors::bag
