// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "io/volume/volume_reader.hpp"

namespace tessera::frame {

/// Opens a volume on all ranks, as io::open_unscanned_volume() does in one process.
///
/// The lowest rank of each machine, its leader, reads the file first. Samples that must be unpacked, or that only a
/// library can read, are written by the leader to a brick file without a name in the directory for temporary files
/// (system/scratch_file.hpp), from which all ranks of the machine read brick by brick. If the samples are read in parts
/// (io::open_unscanned_volume), the leader writes each part as it arrives; otherwise it holds all samples until they
/// are written. If the samples can be read in place, every rank opens the file itself. A rank that is alone on its
/// machine behaves like a single process.
///
/// Every rank has the leader's description of the file; a note reports what was written where. Samples have the same
/// bits as in one process. Collective. Throws this rank's error, which the caller passes to transport.fail(), or the
/// run's error; no file remains in the directory.
io::VolumeFile open_shared_volume(exchange::Transport& transport, const io::InputFile& file,
                                  const ReadOptions& options);

}  // namespace tessera::frame
