// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Ctrl-C and its like. A run of one process that gets SIGINT, SIGTERM or SIGHUP ends at once and leaves nothing: no
/// half-written output, no temporary file, no program that it has started, no line of progress on the terminal. It says
/// one line and ends by that signal, which a shell shows as 128 + its number.
namespace tessera::apps {

/// From now on. A signal that the caller has had ignored (nohup, a background job) stays ignored. Ranks of a job have
/// Job::answer_termination() instead.
void answer_interruption();

/// For whoever is about to report an error: does not return once such a signal has come, since what fails then may fail
/// because of it.
void yield_to_interruption();

}  // namespace tessera::apps
