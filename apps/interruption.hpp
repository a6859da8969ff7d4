// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Handling of Ctrl-C and similar signals. A single-process run that receives SIGINT, SIGTERM or SIGHUP ends at once
/// and cleans up: no incomplete output, temporary file, child program or progress line on the terminal remains. The
/// process prints one line and ends by that signal, which a shell reports as 128 + the number of the signal.
namespace tessera::apps {

/// Installs the handlers. Signals that the caller ignores (nohup, a background job) stay ignored. Ranks of a job use
/// Job::answer_termination() instead.
void answer_interruption();

/// To be called before an error is reported. Does not return if one of these signals has been received, since the
/// signal may be the cause of the error.
void yield_to_interruption();

}  // namespace tessera::apps
