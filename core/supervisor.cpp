#include "core/supervisor.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/say.h"

namespace retrolux {

namespace {

// More tasks at once, or more crashes, than this are not kept apart.
constexpr size_t kSlots = 1024;

struct Crashed {
  uint64_t id = 0;
  int signal = 0;
};

// In memory that the processes share. 0: an empty slot.
struct Board {
  std::array<std::atomic<uint64_t>, kSlots> at_work;
  std::array<uint64_t, kSlots> suspects;
  std::array<Crashed, kSlots> crashed;
};

Board* board = nullptr;

uint64_t Number(const std::string& id) {
  uint64_t number = 0;
  std::from_chars(id.data(), id.data() + id.size(), number, 16);
  return number;
}

Board* MakeBoard() {
  void* memory =
      ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw TryAgainError("not enough memory");
  return new (memory) Board();
}

bool AddCrashed(uint64_t id, int signal) {
  for (Crashed& slot : board->crashed) {
    if (slot.id != 0) continue;
    slot = {id, signal};
    return true;
  }
  return false;
}

bool IsSuspected(uint64_t id) {
  return std::find(board->suspects.begin(), board->suspects.end(), id) != board->suspects.end();
}

bool AddSuspect(uint64_t id) {
  if (IsSuspected(id)) return true;
  const auto empty = std::find(board->suspects.begin(), board->suspects.end(), uint64_t{0});
  if (empty == board->suspects.end()) return false;
  *empty = id;
  return true;
}

// Draws the lesson from a child that died of a signal. False: there is none, it must not be tried
// again. Once may be somebody's kill or the machine's shortness of memory: only a suspect, which is
// tried alone, is given up.
bool LearnFrom(int signal) {
  std::vector<uint64_t> ids;
  for (std::atomic<uint64_t>& slot : board->at_work) {
    const uint64_t id = slot.exchange(0);
    if (id != 0) ids.push_back(id);
  }
  if (ids.empty()) return false;
  if (ids.size() == 1 && IsSuspected(ids.front())) return AddCrashed(ids.front(), signal);
  bool kept = true;
  for (const uint64_t id : ids) kept = AddSuspect(id) && kept;
  return kept;
}

pid_t StartChild(const sigset_t& signals, const sigset_t& before,
                 const std::function<int()>& work) {
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw TryAgainError(fmt::format("no new process ({})", std::strerror(errno)));
  if (child > 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // no work goes on whose supervisor was killed
  if (::getppid() != parent) ::_exit(1);
  // Ending signals stay blocked until the thread is there that takes them.
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EndOnSignals(signals);
  const int code = work();
  // Not exit: libraries that made threads when they were loaded wait for them at exit, and a child
  // has only the thread that forked.
  ::_exit(code);
}

// Waits for its end and hands signals on. Its status as of waitpid.
int WaitFor(pid_t child, const sigset_t& signals) {
  sigset_t all = signals;
  ::sigaddset(&all, SIGCHLD);
  while (true) {
    int status = 0;
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR)
      throw std::runtime_error(fmt::format("lost its process ({})", std::strerror(errno)));
    const int signal = ::sigwaitinfo(&all, nullptr);
    if (signal > 0 && signal != SIGCHLD) ::kill(child, signal);
  }
}

// What a child that died of a signal makes of the work: go on, or its exit code.
std::optional<int> AfterSignal(int signal, const sigset_t& signals) {
  constexpr int kTryAgain = 75;
  if (::sigismember(&signals, signal) == 1) return 128 + signal;
  const bool again = LearnFrom(signal);
  const std::string what = fmt::format("crashed ({})", ::strsignal(signal));
  if (again) {
    Tell(what + "; going on, what it was at alone and last");
    return std::nullopt;
  }
  // Nobody's bug but that of a killer, which mostly is the machine that is short of memory.
  if (signal == SIGKILL) {
    Tell("killed from outside (out of memory?); try again");
    return kTryAgain;
  }
  Tell(what + "; please report it");
  return 1;
}

}  // namespace

int Supervise(const std::function<int()>& work) {
  board = MakeBoard();
  // Where the end of a child is ignored, as some launchers have it, nobody is told of it.
  std::signal(SIGCHLD, SIG_DFL);
  const sigset_t signals = BlockEndingSignals();
  sigset_t before, child_ends;
  ::pthread_sigmask(SIG_SETMASK, nullptr, &before);
  ::sigemptyset(&child_ends);
  ::sigaddset(&child_ends, SIGCHLD);
  ::pthread_sigmask(SIG_BLOCK, &child_ends, nullptr);
  while (true) {
    const int status = WaitFor(StartChild(signals, before, work), signals);
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    if (const auto code = AfterSignal(WTERMSIG(status), signals)) return *code;
  }
}

TaskWatch::TaskWatch(const std::string& id) : slot_(kSlots) {
  if (board == nullptr) return;
  for (slot_ = 0; slot_ < kSlots; ++slot_) {
    uint64_t empty = 0;
    if (board->at_work[slot_].compare_exchange_strong(empty, Number(id))) return;
  }
}

TaskWatch::~TaskWatch() {
  if (slot_ < kSlots) board->at_work[slot_] = 0;
}

bool TaskWatch::IsSuspect(const std::string& id) {
  return board != nullptr && IsSuspected(Number(id));
}

std::string TaskWatch::Crash(const std::string& id) {
  if (board == nullptr) return "";
  const uint64_t number = Number(id);
  for (const Crashed& crash : board->crashed) {
    if (crash.id == number) return fmt::format("crashed ({})", ::strsignal(crash.signal));
  }
  return "";
}

}  // namespace retrolux
