// Loops over threads (oneTBB), and the report of their progress. No result may depend on the order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace retrolux {

// What a long computation tells about itself. Libraries only call this; drawing it is the tool's.
class Progress {
 public:
  virtual ~Progress() = default;
  // A new stage of `total` steps begins; `unit` names what is counted, e.g. "pictures".
  virtual void Begin(const std::string& stage, int64_t total, const std::string& unit) = 0;
  // `steps` more are done. Called from any thread.
  virtual void Advance(int64_t steps) = 0;
  virtual void End() = 0;
};

// Tells nobody.
Progress& NoProgress();

// body(i) for i in [0, count), in any order, on the threads that LimitThreads allows. An exception
// of one call stops the loop and is thrown again here; a loop within another one is not stopped by
// what happens outside of it.
void ParallelFor(int64_t count, const std::function<void(int64_t)>& body);

// While it lives, at most `threads` threads work (0: UsableThreads).
class LimitThreads {
 public:
  explicit LimitThreads(int threads);
  ~LimitThreads();
  LimitThreads(const LimitThreads&) = delete;
  LimitThreads& operator=(const LimitThreads&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace retrolux
