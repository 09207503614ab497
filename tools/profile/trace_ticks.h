// Reads the trace of a run for the page of its profile: what each thread did when, and which spans
// each sample passed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace maploop::profile {

// Returns, with times in units of 100 ns:
//   {"names": [...],
//    "threads": [{"name", "start": [each from the one before], "lasted": [...], "what": [index of
//                 names], "missed": [index of the span after which a deadline was missed]}],
//    "flows": [{"source", "sequence", "spans": [[thread, span], ...]}],   in the order of time
//    "left_out": number of spans that were later than the first `most`}
// A flow is a sample's way from its release to the publication of the state that contains it; one
// that has not arrived is left out. Throws std::runtime_error that names the file if it is not a
// trace of `--trace`.
nlohmann::json read_trace_ticks(const std::filesystem::path& trace, std::size_t most = 250'000);

}  // namespace maploop::profile
