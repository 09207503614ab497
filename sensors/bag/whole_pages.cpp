#include "sensors/bag/whole_pages.h"

#include <sqlite3.h>

#include <array>
#include <stdexcept>

namespace maploop::sensors::bag {
namespace {

// SQLite's own file system, and its functions of an open database.
sqlite3_vfs* system_files = nullptr;
const sqlite3_io_methods* system_methods = nullptr;

int size_of_whole_pages(sqlite3_file* file, sqlite3_int64* size) {
  constexpr sqlite3_int64 page_size_at = 16;  // of the database's header: 2 bytes, big-endian
  std::array<unsigned char, 2> stated{};
  const int result = system_methods->xFileSize(file, size);
  if (result != SQLITE_OK || *size < page_size_at + 2) return result;
  if (system_methods->xRead(file, stated.data(), 2, page_size_at) != SQLITE_OK) return SQLITE_OK;
  const int page = stated[0] << 8 | stated[1];
  *size -= *size % (page == 1 ? 1 << 16 : page == 0 ? 1 : page);  // 1 stands for 65536
  return SQLITE_OK;
}

int open_database(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  const int result = system_files->xOpen(system_files, name, file, flags, out_flags);
  if (result != SQLITE_OK || (flags & SQLITE_OPEN_MAIN_DB) == 0) return result;
  static const sqlite3_io_methods methods = [&] {
    system_methods = file->pMethods;
    sqlite3_io_methods changed = *system_methods;
    changed.xFileSize = size_of_whole_pages;
    return changed;
  }();
  if (file->pMethods == system_methods) file->pMethods = &methods;
  return result;
}

}  // namespace

const char* whole_pages() {
  static sqlite3_vfs files = [] {
    system_files = sqlite3_vfs_find(nullptr);
    if (system_files == nullptr) throw std::runtime_error("SQLite finds no file system");
    sqlite3_vfs changed = *system_files;
    changed.pNext = nullptr;
    changed.zName = "maploop_whole_pages";
    changed.xOpen = open_database;
    return changed;
  }();
  static const int registered = sqlite3_vfs_register(&files, 0);
  if (registered != SQLITE_OK) throw std::runtime_error("SQLite does not take a file system");
  return files.zName;
}

}  // namespace maploop::sensors::bag
