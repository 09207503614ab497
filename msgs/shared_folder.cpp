#include "msgs/shared_folder.h"

#include <dlfcn.h>
#include <link.h>

#include <system_error>

namespace maploop {
namespace {

namespace fs = std::filesystem;

// Returns the file of the program or module.
fs::path own_file() {
  Dl_info ignored{};
  link_map* object = nullptr;
  std::error_code unreadable;
  const auto here = reinterpret_cast<const void*>(&shared_folder);
  const bool known =
      dladdr1(here, &ignored, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  // The program itself has no name in the linker's list.
  if (!known || object == nullptr || *object->l_name == '\0')
    return fs::read_symlink("/proc/self/exe", unreadable);
  return fs::weakly_canonical(object->l_name, unreadable);
}

}  // namespace

fs::path shared_folder() {
  const fs::path folder = own_file().parent_path();
  std::error_code unreadable;
  for (fs::path above = folder; above.has_relative_path(); above = above.parent_path())
    if (fs::is_directory(above / "share/maploop", unreadable)) return above / "share/maploop";
  return folder.parent_path() / "share/maploop";
}

}  // namespace maploop
