// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Into processes of the same program.
enum class MayFork : bool { no, yes };

/// From here on this process changes no file, opens no socket, starts no program and sends no signal to another
/// process: what a damaged or hostile file makes of a library stays in it. It may still read.
///
/// By a seccomp filter, which all its threads have. A kernel without it is no error; builds with sanitizers, which need
/// more, have none.
void give_up_rights(MayFork may_fork);

}  // namespace tessera::readers
