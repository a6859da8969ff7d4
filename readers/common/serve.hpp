// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "readers/common/holdings.hpp"
#include "readers/common/sandbox.hpp"

namespace tessera::readers {

/// A reader of a helper program, with the name used in requests.
struct Reader {
  std::string_view name;
  io::ForeignContents (*read)(Holdings&, const std::filesystem::path&, const nlohmann::json& request);
};

/// Answers the requests of the library that started this process, over descriptor 3, and ends with that process:
///
/// First     {} from the helper: it is running.
/// Requests  {"do": "open", "version", "file", "reader": a name, ...}        -> {"contents"}
/// (io/foreign/messages/foreign_data.hpp)
///           {"do": "take", "array": number, "keep": bool}                   -> {} and a file with its numbers
///           {"do": "window", "slot": bytes} and a file of some slots        -> {}
///           {"do": "put", "array": number, "first", "count", "slot": index} -> {}; the slot contains those tuples
///           {"do": "drop", "arrays": [numbers]}                             -> nothing
/// Failures  {"error": {"line", "code"}} instead.
/// Before the answer to "open", the helper sends any number of {"progress": fraction of the file that was read, 0 to 1}
/// and, for formats of many files, {"reading": the file that is read from now on}; a crash is then attributed to that
/// file.
/// Before the first request, the process gives up its rights (sandbox.hpp). When the caller has ended, for example
/// because it was killed, this process ends immediately, whatever it is doing.
[[noreturn]] void serve(std::span<const Reader> readers, MayFork may_fork = MayFork::no);

/// Reports the fraction of the file that was read, 0 to 1, at most ten times a second. Called by readers.
void report_progress(double done);

/// Reports the file that is read from now on. Called by readers of formats that consist of many files.
void report_reading(const std::filesystem::path& file);

}  // namespace tessera::readers
