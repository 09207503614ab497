// Reads a file that a ZIP archive contains (PKWARE, "APPNOTE.TXT - .ZIP File Format Specification",
// 6.3), as tiles of heights are distributed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace maploop::ppp {

// Returns the content of the first file whose name has this ending, in small letters. Throws
// std::runtime_error that states what is wrong, without the archive's name: it contains no such
// file, is damaged, or is packed in another way than stored or deflated, or the content has more
// than `limit` bytes.
std::string unpacked(std::string_view archive, std::string_view ending, std::size_t limit);

}  // namespace maploop::ppp
