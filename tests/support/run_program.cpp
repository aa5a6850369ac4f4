#include "support/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kNotStarted = 125;  // vantage itself never ends so

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A folder for the three standard streams.
class Streams {
 public:
  Streams() {
    std::string pattern = (fs::temp_directory_path() / "vantage-run-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
  }
  ~Streams() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  fs::path in() const { return folder_ / "in"; }
  fs::path out() const { return folder_ / "out"; }
  fs::path err() const { return folder_ / "err"; }

 private:
  fs::path folder_;
};

/// In the child: only calls that are safe between fork and exec.
[[noreturn]] void become(const char* program, char* const* arguments, const char* folder, const char* in,
                         const char* out, const char* err, const RunOptions& options) {
  const int in_fd = ::open(in, O_RDONLY);
  const int out_fd = ::open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_fd = ::open(err, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (in_fd < 0 || out_fd < 0 || err_fd < 0 || ::chdir(folder) != 0) ::_exit(kNotStarted);
  ::dup2(in_fd, STDIN_FILENO);
  ::dup2(out_fd, STDOUT_FILENO);
  ::dup2(err_fd, STDERR_FILENO);
  if (options.largest_file) {
    const rlimit limit{*options.largest_file, *options.largest_file};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  for (const auto& [resource, most] : options.limits) {
    const rlimit limit{most, most};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
  }
  // Those who run the tests in the background may ignore some, and the program would do so too.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  constexpr unsigned kNobody = 65534;
  if (options.as_nobody && ::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) ::_exit(kNotStarted);
  ::execv(program, arguments);
  ::_exit(kNotStarted);
}

/// What each thread of a process waits for, by the kernel.
std::string threads_of(pid_t process) {
  std::string text = "\nout of time; its threads:";
  std::error_code error;
  for (const fs::directory_entry& thread :
       fs::directory_iterator("/proc/" + std::to_string(process) + "/task", error)) {
    text += "\n" + thread.path().filename().string();
    for (const char* const file : {"comm", "wchan", "syscall"}) {
      std::string of_thread = content(thread.path() / file);
      while (of_thread.ends_with('\n')) of_thread.pop_back();
      text += " " + of_thread;
    }
  }
  return text;
}

}  // namespace

ProgramRun run_program(const fs::path& program, const std::vector<std::string>& arguments, const RunOptions& options) {
  const Streams streams;
  std::ofstream(streams.in(), std::ios::binary) << options.input;
  const std::string executable = fs::absolute(program).string(), folder = options.folder.string(),
                    in = streams.in().string(), out = options.out_file.value_or(streams.out()).string(),
                    err = streams.err().string();
  std::vector<std::string> words = {executable};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const std::string word = options.shows_progress ? options.progress_word : "never";
  if (word.empty()) {
    ::unsetenv("VANTAGE_PROGRESS");
  } else {
    ::setenv("VANTAGE_PROGRESS", word.c_str(), 1);
  }
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    become(executable.c_str(), pointers.data(), folder.c_str(), in.c_str(), out.c_str(), err.c_str(), options);
  }
  ProgramRun run;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(options.timeout_s);
  int status = 0;
  bool is_signalled = options.signal == 0;
  std::string waiting;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (!is_signalled && options.signal_when(content(streams.err()))) {
      ::kill(child, options.signal);
      is_signalled = true;
    }
    if (std::chrono::steady_clock::now() > end) {
      run.timed_out = true;
      waiting = threads_of(child);
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(is_signalled ? 2000 : 200));
  }
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  run.was_started = run.exit_code != kNotStarted;
  run.out = content(streams.out());
  run.err = content(streams.err()) + waiting;
  return run;
}

}  // namespace vantage::testing
