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
/// Before the answer to "open" it sends any number of {"progress": read fraction of the file, 0 to 1} and, for formats
/// of many files, {"reading": the file read from now on}, to which a crash is then attributed.
/// Before the first request the process gives up its rights (sandbox.hpp).
/// As soon as the caller has ended, for example because it was killed, this process ends too, whatever it is doing.
[[noreturn]] void serve(std::span<const Reader> readers, MayFork may_fork = MayFork::no);

/// Reports the read fraction of the file, 0 to 1, at most ten times a second. For readers.
void report_progress(double done);

/// Reports the file that is read from now on. For readers of formats of many files.
void report_reading(const std::filesystem::path& file);

}  // namespace tessera::readers
