#include "kinebase/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "kinebase/core/error.h"

#ifndef KINEBASE_THREAD_SANITIZER
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace kinebase {
namespace {

// Keeps the exception of the smallest index; says when there is no point in beginning more items.
class FirstFailure {
 public:
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

  void Record(std::size_t index) {
    const std::lock_guard lock(mutex_);
    if (!exception_ || index < index_) {
      exception_ = std::current_exception();
      index_ = index;
    }
    failed_.store(true, std::memory_order_relaxed);
  }

  void Rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr exception_;
  std::size_t index_ = 0;
};

}  // namespace

int HardwareThreads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  if (threads <= 0) threads = HardwareThreads();
  threads = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(threads), count));
  FirstFailure failure;
  std::atomic<std::size_t> next{0};
  // Items are handed out one by one in order, so that a long one does not hold up others.
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !failure.failed(); i = next++) {
      try {
        body(i);
      } catch (...) {
        failure.Record(i);
      }
    }
  };
  if (threads <= 1) {
    work();
  } else {
#ifdef KINEBASE_THREAD_SANITIZER
    // The distribution's TBB is not instrumented and gives false reports.
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads; ++i) workers.emplace_back(work);
    workers.clear();
#else
    // More than there are cores gain nothing, and TBB complains about them on standard error.
    threads = std::min(threads, tbb::info::default_concurrency());
    tbb::task_arena arena(threads);
    arena.execute([&] { tbb::parallel_for(0, threads, [&](int) { work(); }); });
#endif
  }
  failure.Rethrow();
}

void ParallelFor(std::size_t count, int threads, std::string_view what,
                 const ProgressCallback& progress, const std::function<void(std::size_t)>& body) {
  std::mutex mutex;
  std::size_t done = 0;
  ParallelFor(count, threads, [&](std::size_t i) {
    body(i);
    if (!progress) return;
    const std::lock_guard lock(mutex);
    ++done;
    if (!progress(what, done, count)) throw Error(ErrorCode::kCancelled, "cancelled");
  });
}

}  // namespace kinebase
