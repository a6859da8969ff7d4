// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "readers/common/holdings.hpp"
#include "readers/common/sandbox.hpp"

namespace tessera::readers {

/// What a helper program reads with, by the name that a request gives.
struct Reader {
  std::string_view name;
  io::ForeignContents (*read)(Holdings&, const std::filesystem::path&, const nlohmann::json& request);
};

/// Answers the requests of the library that started this process, over descriptor 3, and ends with it:
///
/// First     {} from the helper: it runs.
/// Requests  {"do": "open", "version", "file", "reader": a name, ...}        -> {"contents"}
/// (io/foreign/messages/foreign_data.hpp)
///           {"do": "take", "array": number, "keep": bool}                   -> {} and a file with its numbers
///           {"do": "window", "slot": bytes} and a file of some slots        -> {}
///           {"do": "put", "array": number, "first", "count", "slot": index} -> {}; those tuples are in that slot
///           {"do": "drop", "arrays": [numbers]}                             -> nothing
/// Failures  {"error": {"line", "code"}} instead.
/// Before the answer to "open" any number of {"progress": how much of the file is read, 0 to 1} and, of formats that
/// are many files, of {"reading": the one that is read from now on}, which a crash is then said of.
/// Before the first request the process gives up its rights (sandbox.hpp).
/// As soon as the caller is gone, killed perhaps, so is this process, whatever it is at.
[[noreturn]] void serve(std::span<const Reader> readers, MayFork may_fork = MayFork::no);

/// Says how much of the file is read, 0 to 1, if it has not been said for a tenth of a second. For readers.
void report_progress(double done);

/// Says which file is read from now on. For readers of formats that are many files.
void report_reading(const std::filesystem::path& file);

}  // namespace tessera::readers
