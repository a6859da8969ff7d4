// SPDX-License-Identifier: BSD-3-Clause
// Seccomp filters: Linux kernel documentation, "Seccomp BPF (SECure COMPuting with filters)".
#include "readers/common/sandbox.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::readers {

#if defined(__x86_64__) || defined(__aarch64__)
namespace {

#ifdef __x86_64__
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#endif

/// Calls that are refused whatever their arguments. Old calls are left out on newer architectures that lack them.
constexpr std::array refused = {
#ifdef SYS_creat
    SYS_creat,
    SYS_unlink,
    SYS_rename,
    SYS_mkdir,
    SYS_rmdir,
    SYS_link,
    SYS_symlink,
    SYS_mknod,
    SYS_chmod,
    SYS_chown,
    SYS_lchown,
    SYS_utime,
    SYS_utimes,
    SYS_futimesat,
    SYS_fork,
    SYS_vfork,
#endif
    SYS_truncate,
    SYS_unlinkat,
    SYS_renameat,
    SYS_renameat2,
    SYS_mkdirat,
    SYS_linkat,
    SYS_symlinkat,
    SYS_mknodat,
    SYS_fchmod,
    SYS_fchmodat,
    SYS_fchown,
    SYS_fchownat,
    SYS_utimensat,
    SYS_setxattr,
    SYS_lsetxattr,
    SYS_fsetxattr,
    SYS_removexattr,
    SYS_lremovexattr,
    SYS_fremovexattr,
    SYS_socket,
    SYS_execve,
    SYS_execveat,
    SYS_ptrace,
    SYS_process_vm_writev,
    SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo,
    SYS_mount,
    SYS_umount2,
    SYS_unshare,
    SYS_setns,
    SYS_chroot,
    SYS_bpf,
    SYS_keyctl,
    SYS_add_key,
    SYS_open_by_handle_at,
#ifdef SYS_pidfd_send_signal
    SYS_pidfd_send_signal,
    SYS_io_uring_setup,
#endif
};

constexpr std::uint32_t refusal = SECCOMP_RET_ERRNO | EACCES, unknown_call = SECCOMP_RET_ERRNO | ENOSYS;

/// The instructions of the filter, in order. Each check either continues with the next one or jumps to its own result.
class Filter {
 public:
  void load(std::size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); }
  void result(std::uint32_t value) { add(BPF_RET | BPF_K, value); }
  void result_if_equal(std::uint32_t number, std::uint32_t value) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1));
    result(value);
  }
  void result_unless_equal(std::uint32_t number, std::uint32_t value) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 1, 0));
    result(value);
  }
  /// Loads the lower half of an argument if the system call has this number. Instructions added until end_call() apply
  /// to that call.
  void begin_call(long number, std::size_t argument) {
    open_ = code_.size();
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, 0));
    load(offsetof(seccomp_data, args) + 8 * argument);  // little endian, like all supported architectures
  }
  void result_if_any_bit(std::uint32_t bits, std::uint32_t value) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1));
    result(value);
  }
  void result_unless_any_bit(std::uint32_t bits, std::uint32_t value) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 1, 0));
    result(value);
  }
  void end_call() {
    result(SECCOMP_RET_ALLOW);
    code_[open_].jf = static_cast<std::uint8_t>(code_.size() - open_ - 1);
  }

  void install() {
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0)
      ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program);
  }

 private:
  void add(unsigned code, std::uint32_t value) { code_.push_back(BPF_STMT(static_cast<std::uint16_t>(code), value)); }

  std::vector<sock_filter> code_;
  std::size_t open_ = 0;
};

}  // namespace

void give_up_rights(MayFork may_fork) {
  if (is_sanitized) return;
  Filter filter;
  filter.load(offsetof(seccomp_data, arch));
  filter.result_unless_equal(architecture, refusal);
  filter.load(offsetof(seccomp_data, nr));
#ifdef __x86_64__
  constexpr std::uint32_t first_x32 = 0x40000000;
  filter.result_if_any_bit(first_x32, refusal);
#endif
  for (const long call : refused) filter.result_if_equal(static_cast<std::uint32_t>(call), refusal);
  constexpr std::uint32_t writing = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | (O_TMPFILE & ~O_DIRECTORY);
  const auto opens = [&](long call, std::size_t flags) {
    filter.begin_call(call, flags);
    filter.result_if_any_bit(writing, refusal);
    filter.end_call();
  };
#ifdef SYS_open
  opens(SYS_open, 1);
#endif
  opens(SYS_openat, 2);
  // The flags of clone3 and openat2 are in memory, which a filter cannot read. The C library works without these calls.
#ifdef SYS_clone3
  filter.result_if_equal(SYS_clone3, unknown_call);
#endif
#ifdef SYS_openat2
  filter.result_if_equal(SYS_openat2, unknown_call);
#endif
  if (may_fork == MayFork::no) {
    filter.begin_call(SYS_clone, 0);
    filter.result_unless_any_bit(CLONE_THREAD, refusal);
    filter.end_call();
  }
  // abort() sends a signal to its own process.
  for (const long call : {SYS_kill, SYS_tkill, SYS_tgkill}) {
    filter.begin_call(call, 0);
    filter.result_unless_equal(static_cast<std::uint32_t>(::getpid()), refusal);
    filter.end_call();
  }
  filter.result(SECCOMP_RET_ALLOW);
  filter.install();
}

#else
void give_up_rights(MayFork /*may_fork*/) {}  // on other systems, system calls have other numbers or arguments
#endif

}  // namespace tessera::readers
