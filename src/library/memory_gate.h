// Lets no more work in at a time than there is memory for. Internal.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace kinebase::internal {

// Thread-safe. Work that needs more than all of it is let in alone.
class MemoryGate {
 public:
  explicit MemoryGate(std::int64_t bytes) : bytes_(bytes) {}

  // Waits for its share of the memory, and gives it back in the end.
  class Pass {
   public:
    Pass(MemoryGate& gate, std::int64_t bytes) : gate_(gate), bytes_(bytes) {
      std::unique_lock lock(gate_.mutex_);
      gate_.changed_.wait(lock,
                          [&] { return gate_.used_ == 0 || gate_.used_ + bytes_ <= gate_.bytes_; });
      gate_.used_ += bytes_;
    }
    ~Pass() {
      {
        const std::lock_guard lock(gate_.mutex_);
        gate_.used_ -= bytes_;
      }
      gate_.changed_.notify_all();
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

   private:
    MemoryGate& gate_;
    std::int64_t bytes_;
  };

 private:
  std::int64_t bytes_;
  std::int64_t used_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace kinebase::internal
