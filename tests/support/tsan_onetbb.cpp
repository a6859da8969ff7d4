// SPDX-License-Identifier: BSD-3-Clause
// The packaged oneTBB is not compiled for ThreadSanitizer, which therefore does not know that a task begins after it
// was spawned, and that a waiting thread continues after all tasks have ended: every parallel_for would be reported as
// a race. Suppressing everything on oneTBB's threads would hide races of ours. Instead the linker sends the calls into
// its library through here (--wrap, see tessera_test), which informs TSan of exactly the ordering that oneTBB
// guarantees.
#include <sanitizer/tsan_interface.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <cstdlib>
#include <new>

using tbb::detail::d1::delegate_base;
using tbb::detail::d1::execution_data;
using tbb::detail::d1::slot_id;
using tbb::detail::d1::small_object_pool;
using tbb::detail::d1::task;
using tbb::detail::d1::task_arena_base;
using tbb::detail::d1::task_group_context;
using tbb::detail::d1::wait_context;

#define TESSERA_REAL(symbol) __asm__("__real_" symbol)
#define TESSERA_WRAP(symbol) __asm__("__wrap_" symbol) __attribute__((used))

#define TESSERA_SPAWN "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE"
#define TESSERA_SPAWN_TO "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt"
#define TESSERA_EXECUTE_AND_WAIT \
  "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_contextES6_"
#define TESSERA_WAIT "_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE"
#define TESSERA_EXECUTE "_ZN3tbb6detail2r17executeERNS0_2d115task_arena_baseERNS2_13delegate_baseE"
#define TESSERA_ALLOCATE "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEm"
#define TESSERA_ALLOCATE_IN "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEmRKNS2_14execution_dataE"
#define TESSERA_FREE "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvm"
#define TESSERA_FREE_IN "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvmRKNS2_14execution_dataE"
#define TESSERA_ALLOCATE_LINES "_ZN3tbb6detail2r122cache_aligned_allocateEm"
#define TESSERA_FREE_LINES "_ZN3tbb6detail2r124cache_aligned_deallocateEPv"

void real_spawn(task&, task_group_context&) TESSERA_REAL(TESSERA_SPAWN);
void real_spawn_to(task&, task_group_context&, slot_id) TESSERA_REAL(TESSERA_SPAWN_TO);
void real_execute_and_wait(task&, task_group_context&, wait_context&, task_group_context&)
    TESSERA_REAL(TESSERA_EXECUTE_AND_WAIT);
void real_wait(wait_context&, task_group_context&) TESSERA_REAL(TESSERA_WAIT);
void real_execute(task_arena_base&, delegate_base&) TESSERA_REAL(TESSERA_EXECUTE);

void wrap_spawn(task&, task_group_context&) TESSERA_WRAP(TESSERA_SPAWN);
void wrap_spawn_to(task&, task_group_context&, slot_id) TESSERA_WRAP(TESSERA_SPAWN_TO);
void wrap_execute_and_wait(task&, task_group_context&, wait_context&, task_group_context&)
    TESSERA_WRAP(TESSERA_EXECUTE_AND_WAIT);
void wrap_wait(wait_context&, task_group_context&) TESSERA_WRAP(TESSERA_WAIT);
void wrap_execute(task_arena_base&, delegate_base&) TESSERA_WRAP(TESSERA_EXECUTE);
void* wrap_allocate(small_object_pool*&, std::size_t) TESSERA_WRAP(TESSERA_ALLOCATE);
void* wrap_allocate_in(small_object_pool*&, std::size_t, const execution_data&) TESSERA_WRAP(TESSERA_ALLOCATE_IN);
void wrap_free(small_object_pool&, void*, std::size_t) TESSERA_WRAP(TESSERA_FREE);
void wrap_free_in(small_object_pool&, void*, std::size_t, const execution_data&) TESSERA_WRAP(TESSERA_FREE_IN);
void* wrap_allocate_lines(std::size_t) TESSERA_WRAP(TESSERA_ALLOCATE_LINES);
void wrap_free_lines(void*) TESSERA_WRAP(TESSERA_FREE_LINES);

namespace {

// Several threads even on a machine with few cores.
const tbb::global_control more_threads_than_cores(tbb::global_control::max_allowed_parallelism, 8);

/// Runs a spawned task, on whichever thread takes it, after everything that its spawner did before.
class Spawned final : public task {
 public:
  explicit Spawned(task& inner) : inner_(inner) { __tsan_release(this); }

  task* execute(execution_data& data) override {
    __tsan_acquire(this);
    task* next = inner_.execute(data);  // if a task throws, oneTBB calls cancel()
    delete this;
    return next;
  }
  task* cancel(execution_data& data) override {
    __tsan_acquire(this);
    task* next = inner_.cancel(data);
    delete this;
    return next;
  }

 private:
  task& inner_;
};

/// Tasks decrement the context's count when they end. Everything that they did before precedes what their waiter does
/// next, also if one of their exceptions is rethrown.
class AfterWait {
 public:
  explicit AfterWait(wait_context& context) : context_(context) {}
  ~AfterWait() { __tsan_acquire(reinterpret_cast<char*>(&context_) + sizeof(std::uint64_t)); }  // its count
  AfterWait(const AfterWait&) = delete;
  AfterWait& operator=(const AfterWait&) = delete;

 private:
  wait_context& context_;
};
static_assert(sizeof(wait_context) == 2 * sizeof(std::uint64_t));

/// A function that a thread of the arena may call instead of the caller, which waits for it.
class Delegated final : public delegate_base {
 public:
  explicit Delegated(delegate_base& inner) : inner_(inner) { __tsan_release(this); }
  bool operator()() const override {
    const Released done{this};
    __tsan_acquire(const_cast<Delegated*>(this));
    return inner_();
  }

 private:
  struct Released {
    const Delegated* of;
    ~Released() { __tsan_release(const_cast<Delegated*>(of)); }
  };
  delegate_base& inner_;
};

/// New memory each time: oneTBB's pools pass memory between threads without TSan's knowledge.
void* allocate(std::size_t bytes) {
  constexpr std::size_t line = 128;
  void* memory = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void wrap_spawn(task& inner, task_group_context& context) { real_spawn(*new Spawned(inner), context); }
void wrap_spawn_to(task& inner, task_group_context& context, slot_id slot) {
  real_spawn_to(*new Spawned(inner), context, slot);
}
void wrap_execute_and_wait(task& first, task_group_context& of_task, wait_context& wait, task_group_context& of_wait) {
  const AfterWait after(wait);
  real_execute_and_wait(first, of_task, wait, of_wait);
}
void wrap_wait(wait_context& wait, task_group_context& context) {
  const AfterWait after(wait);
  real_wait(wait, context);
}
void wrap_execute(task_arena_base& arena, delegate_base& inner) {
  Delegated delegated(inner);
  const struct Acquired {
    Delegated& from;
    ~Acquired() { __tsan_acquire(&from); }
  } after{delegated};
  real_execute(arena, delegated);
}

void* wrap_allocate(small_object_pool*&, std::size_t bytes) { return allocate(bytes); }
void* wrap_allocate_in(small_object_pool*&, std::size_t bytes, const execution_data&) { return allocate(bytes); }
void wrap_free(small_object_pool&, void* memory, std::size_t) { std::free(memory); }
void wrap_free_in(small_object_pool&, void* memory, std::size_t, const execution_data&) { std::free(memory); }
void* wrap_allocate_lines(std::size_t bytes) { return allocate(bytes); }
void wrap_free_lines(void* memory) { std::free(memory); }
