// SPDX-License-Identifier: BSD-3-Clause
#include "system/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

#include "io/image/image_file.hpp"
#include "support/temporary_folder.hpp"
#include "system/unfinished.hpp"

namespace tessera::io {
namespace {

using test::contents;
using test::expect_bad_input;
using test::fault_of;
using test::TemporaryFolder;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryFolder folder;
  system::AtomicFile file(folder / "out");
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  file.commit();
  EXPECT_EQ(contents(folder / "out"), "hello");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
}

/// Names that appeared in a directory while `work` ran.
template <class Work>
std::vector<std::string> names_made_by(const TemporaryFolder& folder, const Work& work) {
  const int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  EXPECT_GE(inotify_add_watch(watch, (folder / "").c_str(), IN_CREATE | IN_MOVED_TO), 0);
  work();
  alignas(inotify_event) std::array<char, 4096> events{};
  const ssize_t bytes = ::read(watch, events.data(), events.size());
  ::close(watch);
  std::vector<std::string> names;
  for (ssize_t at = 0; at < bytes;) {
    inotify_event event;
    std::memcpy(&event, &events[static_cast<std::size_t>(at)], sizeof(event));
    names.emplace_back(&events[static_cast<std::size_t>(at) + sizeof(event)]);
    at += static_cast<ssize_t>(sizeof(event) + event.len);
  }
  return names;
}

TEST(AtomicFile, HasNoOtherNameBeforeItsOwnUnlessItReplacesAFile) {
  const TemporaryFolder folder;
  if (const int probe = ::open((folder / "").c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666); probe >= 0)
    ::close(probe);
  else
    GTEST_SKIP() << "the file system has no files without a name";
  const auto write = [&] { system::AtomicFile(folder / "out").commit(); };
  EXPECT_EQ(names_made_by(folder, write), std::vector<std::string>{"out"});
  EXPECT_EQ(names_made_by(folder, write).size(), 2u);
}

// In a separate process, which cannot write outputs afterwards.
TEST(AtomicFile, IsRemovedByItsTemporaryNameWhenOutputsAreAbandoned) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    system::AtomicFile nameless(folder / "a"), named(folder / "b"), done(folder / "c");
    nameless.write("half");
    std::ofstream(named.named_part()) << "half";
    done.commit();
    abandon_outputs();
    alarm(1);
    nameless.commit();  // waits for the end
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) << status;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"c"});
}

// The case of a rank that its launcher kills.
TEST(AtomicFile, IsRemovedUnderItsTemporaryNameByASignalsHandlerToo) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGTERM, [](int) {
      system::abandon_in_handler();
      _exit(0);
    });
    system::AtomicFile named(folder / "a"), done(folder / "b");
    std::ofstream(named.named_part()) << "half";
    std::ofstream(done.named_part()) << "whole";
    done.commit();
    for (int k = 0; k < 200; ++k)
      static_cast<void>(system::AtomicFile(folder / "c").named_part());  // each takes a slot and releases it
    [[maybe_unused]] const auto lock = system::naming_outputs();         // whatever it interrupts
    std::raise(SIGTERM);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"b"});
}

TEST(AtomicFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  const TemporaryFolder folder;
  const auto file = folder.write("a", "old");
  const auto own = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(file, own);
  write_text(file, "new");
  EXPECT_EQ(contents(file), "new");
  EXPECT_EQ(std::filesystem::status(file).permissions(), own);
}

TEST(AtomicFile, ReplacesAnOldFileCompletelyOrNotAtAll) {
  const TemporaryFolder folder;
  folder.write("out", "old");
  {
    system::AtomicFile abandoned(folder / "out");
    abandoned.write("half-writt");
  }
  EXPECT_EQ(contents(folder / "out"), "old");
  system::AtomicFile file(folder / "out");
  file.write("new");
  EXPECT_EQ(contents(folder / "out"), "old");
  file.commit();
  EXPECT_EQ(contents(folder / "out"), "new");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
}

TEST(AtomicFile, ANamedPartIsRemovedUnlessCommitted) {
  const TemporaryFolder folder;
  {
    system::AtomicFile file(folder / "out");
    EXPECT_TRUE(std::filesystem::exists(file.named_part()));
    EXPECT_EQ(file.named_part().parent_path(), folder.path());
  }
  EXPECT_TRUE(folder.names().empty());
  system::AtomicFile one(folder / "one"), two(folder / "two");  // at once, in one directory
  EXPECT_NE(one.named_part(), two.named_part());
  std::ofstream(one.named_part()) << "1";
  std::ofstream(two.named_part()) << "2";
  one.commit();
  two.commit();
  EXPECT_EQ(contents(folder / "one") + contents(folder / "two"), "12");
  EXPECT_EQ(folder.names().size(), 2u);
}

TEST(AtomicFile, SeekOverwrites) {
  const TemporaryFolder folder;
  system::AtomicFile file(folder / "out");
  file.write("hello");
  file.seek(1);
  file.write("u");
  EXPECT_EQ(file.position(), 2u);
  file.commit();
  EXPECT_EQ(contents(folder / "out"), "hullo");
}

TEST(AtomicFile, HasThePermissionsOfANewFile) {
  const TemporaryFolder folder;
  const mode_t mask = ::umask(0022);
  system::AtomicFile file(folder / "out");
  file.commit();
  ::umask(mask);
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(folder / "out").permissions()), 0644u);
}

TEST(AtomicFile, AKilledProcessLeavesNothing) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    system::AtomicFile file(folder / "out");
    file.write("half");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  if (!folder.names().empty() && folder.names()[0].starts_with(".tessera-"))
    GTEST_SKIP() << "the file system of " << folder.path() << " has no nameless files";
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, RefusesWhereNothingCanBeWritten) {
  const TemporaryFolder folder;
  folder.write("file", "");
  expect_bad_input([&] { system::AtomicFile(folder / "none/out"); }, {"none/out: ", "make the directory first"});
  expect_bad_input([&] { system::AtomicFile(folder / "file/out"); }, {"file/out: ", "make the directory first"});
  expect_bad_input([&] { system::AtomicFile(folder.path()); }, {"name a file, not a directory"});
  expect_bad_input([&] { system::AtomicFile(folder.path().string() + "/"); }, {"name a file, not a directory"});
  expect_bad_input([&] { system::AtomicFile("/dev/null"); }, {"/dev/null: is not a regular file"});
  expect_bad_input([&] { system::AtomicFile(""); }, {"name a file"});
  expect_bad_input([&] { system::AtomicFile(folder / std::string(300, 'x')); }, {"shorter name"});
  expect_bad_input([&] { system::AtomicFile("/proc/out.png"); }, {"/proc/out.png: "});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

TEST(AtomicFile, RefusesADirectoryWithoutWritePermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_bad_input([&] { system::AtomicFile(folder / "out"); }, {"name a directory you may write in"});
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

/// A file system of 64 KiB during its lifetime.
class TinyDisk {
 public:
  explicit TinyDisk(const std::filesystem::path& at) : at_(at) {
    mounted_ = ::mount("tmpfs", at_.c_str(), "tmpfs", 0, "size=64k") == 0;
  }
  ~TinyDisk() {
    if (mounted_) ::umount(at_.c_str());
  }
  [[nodiscard]] bool mounted() const { return mounted_; }

 private:
  std::filesystem::path at_;
  bool mounted_;
};

TEST(AtomicFile, AFullDiskIsASystemFailureThatLeavesTheOldFile) {
  const TemporaryFolder folder;
  const TinyDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small tmpfs needs root";
  scene::Image image({128, 128});  // 256 KiB of colours that do not compress
  std::uint32_t noise = 1;
  for (float& value : image.rgba) value = static_cast<float>((noise = noise * 1664525 + 1013904223) >> 8) * 0x1p-24f;
  for (const char* name : {"a.exr", "a.png", "a.pfm"}) {
    folder.write(name, "old");
    const auto fault = fault_of([&] { write_image(image, folder / name, {.png_bits = 16}); });
    EXPECT_EQ(fault.code, scene::ErrorCode::system_failure) << name;
    EXPECT_NE(fault.message.find(name), std::string::npos) << fault.message;
    EXPECT_NE(fault.message.find("free some space"), std::string::npos) << fault.message;
    EXPECT_EQ(contents(folder / name), "old");
    std::filesystem::remove(folder / name);
    fault_of([&] { write_image(image, folder / name, {.png_bits = 16}); });
    EXPECT_TRUE(folder.names().empty()) << name;
  }
}

}  // namespace
}  // namespace tessera::io
