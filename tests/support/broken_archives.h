// Checks that an archive refuses broken forms, for the tests of everything that can be saved.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "msgs/archive.h"

namespace maploop::testing {

template <class T>
Bytes saved(const T& value) {
  return sealed_archive([&](ArchiveWriter& ar) { ar(value); });
}

template <class T>
void load(const Bytes& archive, T& value) {
  ArchiveReader reader(unseal(archive));
  reader(value);
  reader.finish();
}

// Returns the reason of the refusal, or an empty string if there was none.
template <class T>
std::string refusal(const Bytes& archive, T& value) {
  try {
    load(archive, value);
    return {};
  } catch (const ArchiveError& error) {
    return error.what();
  }
}

// Loads broken forms of `archive` into `value`, which must refuse each and stay as it was.
template <class T>
void expect_refuses_broken(const Bytes& archive, T& value) {
  const Bytes before = saved(value);
  for (std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{31}, std::size_t{32},
                           archive.size() / 2, archive.size() - 1}) {
    const Bytes cut(archive.begin(), archive.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(refusal(cut, value), "") << "cut to " << size << " bytes";
  }
  for (std::size_t at = 0; at < archive.size(); at += 1 + archive.size() / 97) {
    Bytes flipped = archive;
    flipped[at] ^= 0x10;
    EXPECT_NE(refusal(flipped, value), "") << "byte " << at << " flipped";
  }
  // The content is damaged before its checksum is computed, so that the checksum does not show it.
  const auto content = unseal(archive);
  for (std::size_t size = 0; size < content.size(); size += 1 + content.size() / 97) {
    EXPECT_NE(refusal(seal(content.first(size)), value), "") << "content cut to " << size;
  }
  Bytes longer(content.begin(), content.end());
  longer.push_back(0);
  ArchiveReader reader(longer);
  T other = T(std::move(value));
  reader(other);
  EXPECT_THROW(reader.finish(), ArchiveError) << "a byte too many";
  value = std::move(other);
  load(before, value);
  EXPECT_EQ(saved(value), before);
}

}  // namespace maploop::testing
