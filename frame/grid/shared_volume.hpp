// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "io/volume/volume_reader.hpp"

namespace tessera::frame {

/// io::open_unscanned_volume() by all ranks.
///
/// The lowest rank of each machine, its leader, reads the file first. It writes samples that must be unpacked, or that
/// a library reads, as a nameless brick file to the directory for temporary files (system/scratch_file.hpp), from which
/// all ranks of the machine read brick by brick. If the samples are read in parts (io::open_unscanned_volume), each
/// part is written as it arrives; otherwise the leader holds all of them until they are written. Every rank opens files
/// that are read in place itself. A rank that is alone on its machine behaves like a single process.
///
/// Every rank has the leader's description of the file; a note reports what was written where. Samples have the same
/// bits as in one process. Collective. Throws this rank's error, which the caller passes to transport.fail(), or the
/// run's error; no file remains in the directory.
io::VolumeFile open_shared_volume(exchange::Transport& transport, const io::InputFile& file,
                                  const ReadOptions& options);

}  // namespace tessera::frame
