// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks the symbols that the shared library exports; all others stay internal.
#define TESSERA_EXPORT __attribute__((visibility("default")))
/// Hides members of an exported class.
#define TESSERA_HIDDEN __attribute__((visibility("hidden")))
