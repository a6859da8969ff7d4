#pragma once

/// Marks what the shared library shows; everything else stays inside of it.
#define TESSERA_EXPORT __attribute__((visibility("default")))
