// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks what the shared library shows; everything else stays inside of it.
#define TESSERA_EXPORT __attribute__((visibility("default")))
/// Keeps what a class that is shown declares inside.
#define TESSERA_HIDDEN __attribute__((visibility("hidden")))
