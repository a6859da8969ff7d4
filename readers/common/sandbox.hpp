// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Whether the process may fork (processes of the same program).
enum class MayFork : bool { no, yes };

/// From here on this process cannot change files, open sockets, start programs or signal other processes: effects of a
/// damaged or hostile file on a library stay inside it. It may still read.
///
/// Uses a seccomp filter, which applies to all its threads. A kernel without seccomp is not an error; builds with
/// sanitizers, which need more rights, have no filter.
void give_up_rights(MayFork may_fork);

}  // namespace tessera::readers
