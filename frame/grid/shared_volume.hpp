// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "io/volume/volume_reader.hpp"

namespace tessera::frame {

/// io::open_unscanned_volume() by all ranks.
///
/// Of a machine's ranks the lowest, its leader, reads the file first. Samples that have to be unpacked, or that a
/// library reads, it writes as a brick file without a name into the folder for temporary files
/// (system/scratch_file.hpp); all ranks of the machine read that, brick by brick. It does so as they come, where they
/// come in parts (io::open_unscanned_volume); else it holds them once, for as long as it takes to write them. Files
/// that are read in place every rank opens itself. A rank that is alone on its machine does as one process would.
///
/// Every rank has the leader's description of the file; a note says what was written where. Samples are the same bits
/// as of one process. Collective. Throws this rank's error, which the caller gives to transport.fail(), or the run's;
/// nothing is left in the folder. `options.threads` write bricks.
io::VolumeFile open_shared_volume(exchange::Transport& transport, const io::InputFile& file,
                                  const ReadOptions& options);

}  // namespace tessera::frame
