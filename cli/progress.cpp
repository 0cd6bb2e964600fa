#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "cli/run_json.h"
#include "core/error.h"

namespace retrolux::cli {

namespace {

using Clock = std::chrono::steady_clock;

std::string Duration(double seconds) {
  const auto s = static_cast<int64_t>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string Rate(double per_second, const std::string& unit) {
  if (per_second >= 1e6) return fmt::format("{:.1f} M{}/s", per_second * 1e-6, unit);
  if (per_second >= 1e3) return fmt::format("{:.1f} k{}/s", per_second * 1e-3, unit);
  return fmt::format("{:.1f} {}/s", per_second, unit);
}

// Counts, and draws now and then. What is drawn is the derived class's.
class DrawnProgress : public Progress {
 public:
  explicit DrawnProgress(double interval_s) : interval_s_(interval_s) {}

  void Begin(const std::string& stage, int64_t total, const std::string& unit) override {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    unit_ = unit;
    total_ = total;
    done_ = 0;
    start_ = drawn_ = Clock::now();
    Draw(false);
  }
  void Advance(int64_t steps) override {
    const std::lock_guard lock(mutex_);
    done_ += steps;
    if (std::chrono::duration<double>(Clock::now() - drawn_).count() < interval_s_) return;
    drawn_ = Clock::now();
    Draw(false);
  }
  void End() override {
    const std::lock_guard lock(mutex_);
    Draw(true);
  }

 protected:
  virtual void Draw(bool last) = 0;
  double Elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double PerSecond() const {
    return Elapsed() > 0.0 ? static_cast<double>(done_) / Elapsed() : 0.0;
  }
  double SecondsLeft() const {
    return done_ > 0 ? static_cast<double>(total_ - done_) / PerSecond() : 0.0;
  }

  std::string stage_, unit_;
  int64_t total_ = 0;
  int64_t done_ = 0;

 private:
  double interval_s_;
  std::mutex mutex_;
  Clock::time_point start_, drawn_;
};

class Bar : public DrawnProgress {
 public:
  Bar() : DrawnProgress(0.1) {}

 protected:
  void Draw(bool last) override {
    constexpr int kWidth = 30;
    const double share =
        total_ > 0 ? static_cast<double>(done_) / static_cast<double>(total_) : 1.0;
    const int filled = static_cast<int>(share * kWidth);
    const std::string time = last ? "in " + Duration(Elapsed()) : Duration(SecondsLeft()) + " left";
    Say(fmt::format("\r\033[K{} [{}{}] {:3.0f} %  {}  {}{}", stage_,
                    std::string(static_cast<size_t>(filled), '#'),
                    std::string(static_cast<size_t>(kWidth - filled), '.'), 100.0 * share,
                    Rate(PerSecond(), unit_), time, last ? "\n" : ""));
  }
};

class JsonLines : public DrawnProgress {
 public:
  explicit JsonLines(const ThreadLimit& threads) : DrawnProgress(5.0) {
    const nlohmann::json line = {{"threads", threads.threads}, {"threads_from", threads.source}};
    Say(line.dump() + "\n");
  }

 protected:
  void Draw(bool last) override {
    const nlohmann::json line = {
        {"stage", stage_},        {"done", done_},           {"total", total_}, {"unit", unit_},
        {"elapsed_s", Elapsed()}, {"left_s", SecondsLeft()}, {"finished", last}};
    Say(line.dump() + "\n");
  }
};

class Silence : public Progress {
 public:
  void Begin(const std::string&, int64_t, const std::string&) override {}
  void Advance(int64_t) override {}
  void End() override {}
};

}  // namespace

std::unique_ptr<Progress> MakeProgress(const GlobalOptions& global) {
  if (global.progress == "json") return std::make_unique<JsonLines>(ThreadsOf(global));
  if (global.quiet || global.progress == "none" || ::isatty(STDERR_FILENO) == 0)
    return std::make_unique<Silence>();
  return std::make_unique<Bar>();
}

void PrintResult(const GlobalOptions& global, const nlohmann::json& summary,
                 const std::string& text) {
  if (global.quiet && !global.json) return;
  const std::string result = (global.json ? summary.dump(2) : text) + "\n";
  const bool whole = std::fwrite(result.data(), 1, result.size(), stdout) == result.size();
  if ((whole && std::fflush(stdout) == 0) || errno == EPIPE) return;
  throw TryAgainError(fmt::format("stdout: cannot write the result: {}", std::strerror(errno)));
}

}  // namespace retrolux::cli
