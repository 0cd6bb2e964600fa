#include "core/task_manifest.h"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <thread>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/supervisor.h"
#include "tests/message_of.h"

namespace retrolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::HasSubstr;

// An empty folder for each test.
class TaskManifestTest : public testing::Test {
 protected:
  TaskManifestTest()
      : folder_(fs::path(testing::TempDir()) / "retrolux_task_manifest_test" /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
  }
  ~TaskManifestTest() override { fs::remove_all(folder_); }

  // In the order of their names.
  std::vector<fs::path> ResultFiles() const {
    std::vector<fs::path> files;
    for (const auto& file : fs::directory_iterator(folder_ / "tasks")) {
      if (IsResultName(file.path().filename())) files.push_back(file.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  fs::path folder_;
};

std::vector<Task> Tasks(int count) {
  std::vector<Task> tasks;
  for (int i = 0; i < count; ++i) tasks.push_back({fmt::format("task {}", i), {{"index", i}}});
  return tasks;
}

// Digits that a shorter print than the shortest exact one would lose.
Json Value(size_t task) {
  return {{"root", std::sqrt(static_cast<double>(task) + 2.0)}, {"task", task}};
}

// A run of the tasks by Value in a manifest of its own.
struct Outcome {
  std::vector<Json> results;
  TaskReport report;
  int64_t worked = 0;
};

Outcome RunAll(const fs::path& folder, const std::vector<Task>& tasks, const TaskLoop& loop = {},
               const Json& options = {{"seed", 1}}) {
  Outcome outcome;
  std::atomic<int64_t> worked = 0;
  TaskManifest manifest(folder, "roots", options);
  outcome.results = manifest.Run(
      "values", tasks,
      [&](size_t task) {
        ++worked;
        return Value(task);
      },
      NoProgress(), loop);
  outcome.report = manifest.Report();
  outcome.worked = worked;
  return outcome;
}

TEST_F(TaskManifestTest, ResultsComeInOrderAndExactly) {
  const Outcome outcome = RunAll(folder_, Tasks(20));
  ASSERT_EQ(outcome.results.size(), 20u);
  for (size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(outcome.results[i]["task"], i);
    EXPECT_EQ(outcome.results[i]["root"].get<double>(), std::sqrt(static_cast<double>(i) + 2.0));
  }
  EXPECT_EQ(outcome.report.done_now, 20);
  EXPECT_EQ(outcome.report.Text(), "");
}

TEST_F(TaskManifestTest, ASecondRunWorksNotAtAllAndGivesTheSame) {
  const Outcome first = RunAll(folder_, Tasks(5));
  const Outcome second = RunAll(folder_, Tasks(5));
  EXPECT_EQ(second.worked, 0);
  EXPECT_EQ(second.results, first.results);
  EXPECT_EQ(second.report.Text(), "skipped 5 of 5 tasks (done before)");
}

TEST_F(TaskManifestTest, GoesOnAfterAPartialRun) {
  RunAll(folder_, Tasks(3));
  const Outcome whole = RunAll(folder_, Tasks(8));
  EXPECT_EQ(whole.worked, 5);
  EXPECT_EQ(whole.report.done_before, 3);
  EXPECT_EQ(whole.results[2], Value(2));
  EXPECT_EQ(whole.results[7], Value(7));
}

TEST_F(TaskManifestTest, ResultsThatAreNoneAreDoneAgainWithAWarning) {
  const std::vector<Json> expected = RunAll(folder_, Tasks(5)).results;
  const std::vector<fs::path> files = ResultFiles();
  ASSERT_EQ(files.size(), 5u);
  const std::string text = ReadTextFile(files[0]);
  std::string flipped = text;
  flipped[text.find("\"root\":") + 9] ^= 1;  // a digit of the number
  WriteTextFile(files[0], flipped);
  WriteTextFile(files[1], ReadTextFile(files[1]).substr(0, 60));
  WriteTextFile(files[2], "");
  WriteTextFile(files[3], text);  // whole, and of another task
  const Outcome outcome = RunAll(folder_, Tasks(5));
  EXPECT_EQ(outcome.worked, 4);
  EXPECT_EQ(outcome.results, expected);
  ASSERT_EQ(outcome.report.warnings.size(), 4u);
  EXPECT_THAT(outcome.report.warnings,
              testing::Contains(HasSubstr(files[1].string() + ": damaged; expected a whole file")));
  EXPECT_THAT(outcome.report.warnings, testing::Contains(HasSubstr("not of this task; expected")));
  EXPECT_THAT(outcome.report.warnings, testing::Each(HasSubstr("is done again")));
  EXPECT_EQ(ReadTextFile(files[0]), text);
  EXPECT_EQ(RunAll(folder_, Tasks(5)).worked, 0);
}

TEST_F(TaskManifestTest, OtherWorkIsRefusedAndToldWhatChanged) {
  const Json options = {{"seed", 1}, {"camera", {{"spp", 8}, {"size", {640, 480}}}}};
  RunAll(folder_, Tasks(4), {}, options);
  const std::string manifest = ReadTextFile(folder_ / "manifest.json");
  Json changed = options;
  changed["camera"]["spp"] = 4;
  changed["gain"] = 2;
  EXPECT_EQ(
      MessageOf([&] { RunAll(folder_, Tasks(4), {}, changed); }),
      folder_.string() +
          ": holds results of other work; options: /camera/spp was 8, is 4; /gain was not, is "
          "2; expected another folder, or the options that this one was begun with");
  EXPECT_THAT(MessageOf([&] { TaskManifest(folder_, "cubes", options); }),
              HasSubstr("study: was \"roots\", is \"cubes\""));
  EXPECT_EQ(ReadTextFile(folder_ / "manifest.json"), manifest);
  EXPECT_EQ(RunAll(folder_, Tasks(4), {}, options).worked, 0);
  for (const fs::path& file : ResultFiles()) fs::remove(file);
  EXPECT_EQ(RunAll(folder_, Tasks(4), {}, changed).worked, 4);  // there is nothing to mix with
}

TEST_F(TaskManifestTest, FewerTasksLeaveTheOthersAlone) {
  RunAll(folder_, Tasks(4));
  const Outcome fewer = RunAll(folder_, Tasks(3));
  EXPECT_EQ(fewer.worked, 0);
  EXPECT_EQ(fewer.report.others, 1);
  EXPECT_EQ(fewer.report.Text(),
            "skipped 3 of 3 tasks (done before); 1 results of other work left alone");
}

TEST_F(TaskManifestTest, NamesAndTheOrderOfKeysDefineNothing) {
  RunAll(folder_, {{"one", Json::parse(R"({"a": 1, "b": {"c": 2, "d": 3}})")}});
  const Task reordered{"another name", Json::parse(R"({"b": {"d": 3, "c": 2}, "a": 1})")};
  EXPECT_EQ(RunAll(folder_, {reordered}).worked, 0);
  const Task different{"one", Json::parse(R"({"a": 1, "b": {"c": 2, "d": 4}})")};
  EXPECT_EQ(RunAll(folder_, {different}).worked, 1);
}

TEST_F(TaskManifestTest, AFailureKeepsAllOthers) {
  for (const bool parallel : {false, true}) {
    const fs::path folder = folder_ / (parallel ? "parallel" : "serial");
    TaskLoop loop;
    loop.parallel = parallel;
    const auto work = [](size_t task) {
      if (task == 3 || task == 7) throw InputError(fmt::format("no light in {}", task));
      std::atomic<int> inner = 0;
      ParallelFor(100, [&](int64_t) { ++inner; });
      EXPECT_EQ(inner, 100);  // the failure of another task cuts no loop short
      return Value(task);
    };
    TaskManifest manifest(folder, "roots", {{"seed", 1}});
    try {
      manifest.Run("values", Tasks(40), work, NoProgress(), loop);
      ADD_FAILURE() << "no failure";
    } catch (const TasksFailed& failed) {
      EXPECT_STREQ(failed.what(), "2 of 40 tasks failed; what is done is kept");
      EXPECT_THAT(failed.Failures(), testing::ElementsAre("task 3 (number 3): no light in 3",
                                                          "task 7 (number 7): no light in 7"));
    }
    EXPECT_EQ(manifest.Report().done_now, 38);
    const StoredTask third = manifest.Store().Place(Tasks(40)[3]);
    EXPECT_EQ(manifest.Store().Failure(third), "no light in 3");
    EXPECT_EQ(RunAll(folder, Tasks(40)).worked, 2);
    EXPECT_EQ(manifest.Store().Failure(third), "");
  }
}

TEST_F(TaskManifestTest, AFullDiskStopsTheStage) {
  TaskManifest manifest(folder_, "roots", {{"seed", 1}});
  int begun = 0;
  const auto work = [&](size_t task) -> Json {
    ++begun;
    if (task == 2) throw TryAgainError("disk full");
    return Value(task);
  };
  TaskLoop serial;
  serial.parallel = false;
  EXPECT_THROW(manifest.Run("values", Tasks(10), work, NoProgress(), serial), TryAgainError);
  EXPECT_EQ(begun, 3);
  EXPECT_EQ(RunAll(folder_, Tasks(10)).worked, 8);
}

TEST_F(TaskManifestTest, AResultThatJsonCannotHoldIsNotKept) {
  TaskManifest manifest(folder_, "roots", {{"seed", 1}});
  const auto work = [](size_t) { return Json(std::numeric_limits<double>::quiet_NaN()); };
  EXPECT_THROW(manifest.Run("values", Tasks(1), work), TasksFailed);
  EXPECT_TRUE(ResultFiles().empty());
}

TEST_F(TaskManifestTest, ThreadsChangeNothing) {
  std::vector<std::string> texts;
  for (const int threads : {1, 4}) {
    const fs::path folder = folder_ / std::to_string(threads);
    const LimitThreads limit(threads);
    RunAll(folder, Tasks(50));
    std::string text = ReadTextFile(folder / "manifest.json");
    std::set<fs::path> files;
    for (const auto& file : fs::directory_iterator(folder / "tasks")) {
      if (IsResultName(file.path().filename())) files.insert(file.path());
    }
    for (const fs::path& file : files) text += file.filename().string() + ReadTextFile(file);
    texts.push_back(text);
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST_F(TaskManifestTest, StagesStandInOneManifest) {
  const auto run = [&] {
    TaskManifest manifest(folder_, "roots", {{"seed", 1}});
    const std::vector<Json> first = manifest.Run("phase 1", Tasks(3), Value);
    std::vector<Task> second = {Tasks(2)[1]};  // one that phase 1 has done
    second.push_back({"follows", {{"from", first[2]["root"]}}});
    manifest.Run("phase 2", second, [](size_t task) { return Value(task + 10); });
    return manifest.Report();
  };
  EXPECT_EQ(run().done_now, 4);
  const TaskReport again = run();
  EXPECT_EQ(again.done_now, 0);
  EXPECT_EQ(again.done_before, 4);
  EXPECT_EQ(again.others, 0);
  const Json manifest = Json::parse(ReadTextFile(folder_ / "manifest.json"));
  EXPECT_EQ(manifest["schema"], "retrolux/manifest-1");
  EXPECT_EQ(manifest["stages"][1]["stage"], "phase 2");
  EXPECT_EQ(manifest["stages"][1]["tasks"][0]["id"], manifest["stages"][0]["tasks"][1]["id"]);
  EXPECT_EQ(manifest["stages"][1]["tasks"][1]["name"], "follows");
}

TEST_F(TaskManifestTest, ResultsThatAreNoLongerUsableAreDoneAgain) {
  RunAll(folder_, Tasks(4));
  TaskLoop loop;
  loop.usable = [](const Json& result) { return result["task"] != 2; };
  const Outcome outcome = RunAll(folder_, Tasks(4), loop);
  EXPECT_EQ(outcome.worked, 1);
  EXPECT_THAT(outcome.report.warnings,
              testing::ElementsAre(HasSubstr("no longer usable; expected all that")));
}

class CountingProgress : public Progress {
 public:
  void Begin(const std::string& stage, int64_t total, const std::string& unit) override {
    text = fmt::format("{}: {} {}", stage, total, unit);
  }
  void Advance(int64_t steps) override { done += steps; }
  void End() override { ended = true; }

  std::string text;
  std::atomic<int64_t> done = 0;
  bool ended = false;
};

TEST_F(TaskManifestTest, ProgressCountsWhatIsLeft) {
  RunAll(folder_, Tasks(2));
  CountingProgress tasks;
  TaskManifest(folder_, "roots", {{"seed", 1}}).Run("values", Tasks(5), Value, tasks);
  EXPECT_EQ(tasks.text, "values, skipped 2 of 5 (done before): 3 tasks");
  EXPECT_EQ(tasks.done, 3);
  EXPECT_TRUE(tasks.ended);

  CountingProgress pictures;
  TaskLoop loop;
  loop.unit = "pictures";
  loop.steps_per_task = 12;
  const auto work = [&](size_t task) {
    pictures.Advance(12);
    return Value(task);
  };
  TaskManifest(folder_, "roots", {{"seed", 1}}).Run("values", Tasks(6), work, pictures, loop);
  EXPECT_EQ(pictures.text, "values, skipped 5 of 6 (done before): 12 pictures");
  EXPECT_EQ(pictures.done, 12);
}

TEST_F(TaskManifestTest, OnlyWhatIsChosenIsDone) {
  TaskLoop loop;
  loop.chosen = [](size_t task) { return task % 2 == 1; };
  TaskManifest manifest(folder_, "roots", {{"seed", 1}});
  const std::vector<bool> half = {false, true, false, true};
  EXPECT_EQ(manifest.Do("values", Tasks(4), Value, NoProgress(), loop), half);
  EXPECT_EQ(manifest.Report().done_now, 2);
  EXPECT_EQ(manifest.Store().Read(manifest.Store().Place(Tasks(4)[1])), Value(1));

  loop.chosen = [](size_t) { return false; };
  TaskManifest again(folder_, "roots", {{"seed", 1}});
  EXPECT_EQ(again.Do("values", Tasks(4), Value, NoProgress(), loop), half);
  EXPECT_EQ(again.Report().done_before, 2);
}

TEST_F(TaskManifestTest, NothingIsBegunWhenTheTimeIsOver) {
  TaskLoop loop;
  loop.parallel = false;
  const auto start = std::chrono::steady_clock::now();
  loop.until = start + std::chrono::milliseconds(50);
  TaskManifest manifest(folder_, "roots", {{"seed", 1}});
  const auto work = [](size_t task) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    return Value(task);
  };
  const std::vector<bool> done = manifest.Do("values", Tasks(8), work, NoProgress(), loop);
  EXPECT_TRUE(done[0]);
  EXPECT_FALSE(done[7]);
  EXPECT_EQ(manifest.Report().done_now + manifest.Report().out_of_time, 8);
  EXPECT_THAT(manifest.Report().Text(), HasSubstr("the time was over before"));
}

// Two manifests in one process are as two processes: their locks are of two open files.
TEST_F(TaskManifestTest, TwoRunsAtOnceShareTheTasks) {
  constexpr int kTasks = 60;
  std::atomic<int64_t> worked = 0;
  std::array<TaskReport, 2> reports;
  std::array<std::vector<Json>, 2> results;
  const auto run = [&](size_t i) {
    TaskLoop loop;
    loop.parallel = false;
    TaskManifest manifest(folder_, "roots", {{"seed", 1}});
    const auto work = [&](size_t task) {
      ++worked;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      return Value(task);
    };
    results[i] = manifest.Run("values", Tasks(kTasks), work, NoProgress(), loop);
    reports[i] = manifest.Report();
  };
  std::thread other(run, 1);
  run(0);
  other.join();
  EXPECT_EQ(worked, kTasks);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0].size(), size_t{kTasks});
  for (const TaskReport& report : reports)
    EXPECT_EQ(report.done_before + report.done_now + report.done_elsewhere, kTasks);
  EXPECT_GT(reports[0].done_now, 0);
  EXPECT_GT(reports[1].done_now, 0);
}

// A process that is gone has left a temporary file; one of a process that lives is not touched, nor
// one from elsewhere, unless nobody has written to it for a day.
TEST_F(TaskManifestTest, LeftoversOfDeadProcessesAreRemoved) {
  RunAll(folder_, Tasks(1));
  const fs::path tasks = folder_ / "tasks";
  const pid_t child = ::fork();
  if (child == 0) {
    const AtomicFile dead(tasks / "dead.json");
    std::ofstream(dead.Temporary()) << "half";
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  const AtomicFile alive(tasks / "alive.json");
  const fs::path elsewhere = tasks / ".x.0123ab-4567cd-1-89abcdef.part.json";
  const fs::path old = tasks / ".x.0123ab-4567cd-2-89abcdef.part.json";
  const fs::path other = tasks / ".x.part.json";
  for (const fs::path& file : {alive.Temporary(), elsewhere, old, other})
    std::ofstream(file) << "half";
  fs::last_write_time(old, fs::last_write_time(elsewhere) - std::chrono::hours(25));
  RunAll(folder_, Tasks(1));
  std::set<std::string> left;
  for (const fs::directory_entry& file : fs::directory_iterator(tasks)) {
    const std::string name = file.path().filename();
    if (name.find(".part") != std::string::npos) left.insert(name);
  }
  EXPECT_EQ(left, (std::set<std::string>{alive.Temporary().filename(), elsewhere.filename(),
                                         other.filename()}));
}

// Two at once with other options: the second is refused before there is any result.
TEST_F(TaskManifestTest, OtherWorkIsRefusedWhileSomebodyIsAtWork) {
  const TaskManifest first(folder_, "roots", {{"seed", 1}});
  EXPECT_THAT(MessageOf([&] {
                TaskManifest(folder_, "roots", {{"seed", 2}});
              }),
              HasSubstr("another process is at other work here; options: /seed was 1, is 2"));
  const TaskManifest same(folder_, "roots", {{"seed", 1}});
}

// A folder that was begun and has no result may be used for other work.
TEST_F(TaskManifestTest, OtherWorkIsTakenWhereNothingWasDone) {
  { const TaskManifest first(folder_, "roots", {{"seed", 1}}); }
  const TaskManifest other(folder_, "roots", {{"seed", 2}});
  EXPECT_EQ(ReadManifest(folder_).at("options").at("seed"), 2);
}

// Supervised work of twenty tasks, one of which crashes it each time. Returns its exit code; what
// failed is in failures.txt.
int RunWithACrash(const fs::path& folder, bool parallel) {
  fs::create_directories(folder);
  return Supervise([&] {
    TaskLoop loop;
    loop.parallel = parallel;
    TaskManifest manifest(folder, "roots", {{"seed", 1}});
    const auto work = [](size_t task) {
      if (task == 5) std::raise(SIGKILL);  // SIGSEGV is the sanitizer's
      return Value(task);
    };
    try {
      manifest.Run("values", Tasks(20), work, NoProgress(), loop);
    } catch (const TasksFailed& failed) {
      WriteTextFile(folder / "failures.txt", fmt::format("{}", fmt::join(failed.Failures(), "\n")));
      return 4;
    }
    return 0;
  });
}

// "threadsafe": in a new process, as the supervisor must come before threads.
TEST_F(TaskManifestTest, ATaskThatCrashesIsNamedAndTheOthersAreDone) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(std::exit(RunWithACrash(folder_, false)), testing::ExitedWithCode(4), "crashed");
  EXPECT_EQ(ReadTextFile(folder_ / "failures.txt"), "task 5 (number 5): crashed (Killed)");
  EXPECT_EQ(RunAll(folder_, Tasks(20)).worked, 1);
}

TEST_F(TaskManifestTest, ACrashAmongSeveralTasksIsFoundByTryingEachAlone) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(std::exit(RunWithACrash(folder_, true)), testing::ExitedWithCode(4), "crashed");
  EXPECT_EQ(ReadTextFile(folder_ / "failures.txt"), "task 5 (number 5): crashed (Killed)");
  EXPECT_EQ(RunAll(folder_, Tasks(20)).worked, 1);
}

TEST_F(TaskManifestTest, ACrashOutsideOfTasksIsNotTriedAgain) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto crash = [] { return std::raise(SIGABRT); };
  EXPECT_EXIT(std::exit(Supervise(crash)), testing::ExitedWithCode(1), "please report it");
  const auto killed = [] { return std::raise(SIGKILL); };
  EXPECT_EXIT(std::exit(Supervise(killed)), testing::ExitedWithCode(75), "killed from outside");
}

// Some launchers have the end of children ignored.
TEST_F(TaskManifestTest, TheEndIsSeenWhereChildrenAreIgnored) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        std::signal(SIGCHLD, SIG_IGN);
        std::exit(Supervise([] { return 3; }));
      },
      testing::ExitedWithCode(3), "");
}

TEST_F(TaskManifestTest, AFolderThatCannotBeIsRefused) {
  EXPECT_THAT(MessageOf([] { TaskManifest("/proc/no/such/place", "roots", Json::object()); }),
              HasSubstr("expected a place that can be written to"));
}

}  // namespace
}  // namespace retrolux
