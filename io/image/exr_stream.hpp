// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <exception>
#include <string>

#include "system/atomic_file.hpp"

namespace tessera::io {

/// A stream that lets OpenEXR write into an AtomicFile.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(system::AtomicFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    keep([&] { file_.write(bytes, static_cast<std::size_t>(count)); });
  }
  std::uint64_t tellp() override { return file_.position(); }
  void seekp(std::uint64_t position) override {
    keep([&] { file_.seek(position); });
  }
  /// Throws the error of a failed write again. Needed because OpenEXR writes its table of lines in a destructor, which
  /// discards exceptions.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  template <class Action>
  void keep(const Action& action) {
    try {
      action();
    } catch (...) {
      if (!failure_) failure_ = std::current_exception();
      throw;
    }
  }
  system::AtomicFile& file_;
  std::exception_ptr failure_;
};

}  // namespace tessera::io
