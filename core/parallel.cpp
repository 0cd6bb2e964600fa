#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/thread_limit.h"

namespace retrolux {

namespace {

class SilentProgress : public Progress {
 public:
  void Begin(const std::string&, int64_t, const std::string&) override {}
  void Advance(int64_t) override {}
  void End() override {}
};

}  // namespace

Progress& NoProgress() {
  static SilentProgress silent;
  return silent;
}

void ParallelFor(int64_t count, const std::function<void(int64_t)>& body) {
  // A context of its own: an exception that ends an outer loop must not cut short the loops within
  // its other rounds, which would take half of their work for the whole.
  tbb::task_group_context own(tbb::task_group_context::isolated);
  // Isolated: a thread that waits for the end of a loop within a loop must not begin another round
  // of the outer one, whose memory it would hold beside its own.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        tbb::blocked_range<int64_t>(0, count, 1),
        [&](const tbb::blocked_range<int64_t>& range) {
          for (int64_t i = range.begin(); i != range.end(); ++i) body(i);
        },
        tbb::simple_partitioner(), own);
  });
}

LimitThreads::LimitThreads(int threads) {
  const int limit = threads > 0 ? threads : UsableThreads().threads;
  control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                     static_cast<size_t>(limit));
}

LimitThreads::~LimitThreads() {
  delete static_cast<tbb::global_control*>(control_);
}

}  // namespace retrolux
