// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Declarations of CLI11's classes: its header takes a compiler five seconds, so that sources which declare options
/// include it and headers do not.
namespace CLI {
class App;
class Option;
}  // namespace CLI
