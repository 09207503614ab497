// This file holds the samples of one table, and what is wrong with each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "sensors/replay/timestamps.h"
#include "sensors/source.h"

namespace maploop::sensors {

template <class T>
struct TableRows {
  std::filesystem::path file;
  std::vector<T> samples;
  Verdicts verdicts;  // one for each sample

  // Return the first and the last sample that can be used; nullptr: there is none.
  const T* first() const {
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (!verdicts[i]) return &samples[i];
    return nullptr;
  }
  const T* last() const {
    for (std::size_t i = samples.size(); i-- > 0;)
      if (!verdicts[i]) return &samples[i];
    return nullptr;
  }
};

// Delivers the samples without a verdict, and reports the others.
template <class T>
std::unique_ptr<Source<T>> source_of(std::shared_ptr<const TableRows<T>> rows) {
  return made<T>(
      [rows = std::move(rows), index = std::size_t{0}](T& sample, SourceReport& report) mutable {
        while (index < rows->samples.size()) {
          const std::size_t i = index++;
          if (!rows->verdicts[i]) {
            sample = rows->samples[i];
            return true;
          }
          report.refuse(*rows->verdicts[i]);
        }
        return false;
      });
}

}  // namespace maploop::sensors
