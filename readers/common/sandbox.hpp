// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Whether the process may fork, which starts processes of the same program only.
enum class MayFork : bool { no, yes };

/// Makes this process unable to change files, open sockets, start programs or signal other processes, so that a damaged
/// or hostile file that exploits a library cannot affect anything else. The process may still read files.
///
/// Uses a seccomp filter, which applies to all threads of the process. A kernel without seccomp is not an error. Builds
/// with sanitizers do not install a filter, because sanitizers need more rights.
void give_up_rights(MayFork may_fork);

}  // namespace tessera::readers
