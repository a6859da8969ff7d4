// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::test {

/// Repeatedly changes a few of the bytes, writes them to `name` and reads that: it must be read or refused in one line
/// that begins with the file's name, whatever the bytes. TESSERA_TRIALS sets the number of repetitions.
inline void expect_no_crash_of_changes(const TemporaryFolder& folder, const std::string& name, const std::string& bytes,
                                       const std::function<void(const std::filesystem::path&)>& read) {
  const char* const wish = std::getenv("TESSERA_TRIALS");
  const unsigned trials = wish == nullptr ? 12 : static_cast<unsigned>(std::atoi(wish));
  SomeCases some(3);
  for (unsigned seed = 1; seed <= trials; ++seed) {
    if (!some.next()) continue;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string changed = bytes;
    // Every second time only in the header.
    const std::size_t reach = seed % 2 == 1 ? std::min<std::size_t>(bytes.size(), 600) : bytes.size();
    for (unsigned k = 0; k < 1 + seed % 4; ++k) changed[random() % reach] = static_cast<char>(random());
    const auto file = folder.write(name, changed);
    const Fault fault = fault_of([&] { read(file); });
    if (!fault.code) continue;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_TRUE(fault.message.starts_with(folder.path().string())) << fault.message;
    EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
  }
}

}  // namespace tessera::test
