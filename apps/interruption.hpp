// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Handling of Ctrl-C and similar signals. A single-process run that gets SIGINT, SIGTERM or SIGHUP ends at once and
/// cleans up: it leaves no incomplete output, temporary file, child program or progress line on the terminal. It prints
/// one line and ends by that signal, which a shell reports as 128 + its number.
namespace tessera::apps {

/// Installs the handlers. Signals that the caller ignores (nohup, a background job) stay ignored. Ranks of a job use
/// Job::answer_termination() instead.
void answer_interruption();

/// Call it before an error is reported: does not return if such a signal has been received, as the signal may be the
/// cause of the error.
void yield_to_interruption();

}  // namespace tessera::apps
