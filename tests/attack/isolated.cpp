#include "isolated.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace attack {
namespace {

constexpr char kEnd[] = "\nthe end\n";

[[noreturn]] void work_and_exit(int to, unsigned seconds, const std::function<std::string()>& work) {
  const rlimit limit{seconds, seconds + 5};
  setrlimit(RLIMIT_CPU, &limit);
  alarm(20 * seconds);  // one that sleeps
  std::string text = work() + kEnd;
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = write(to, text.data() + at, text.size() - at);
    if (written <= 0) _exit(1);
    at += static_cast<std::size_t>(written);
  }
  _exit(0);
}

Exit finish(const std::string& text, int status) {
  Exit exit;
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    exit.hung = signal == SIGALRM || signal == SIGXCPU || signal == SIGKILL;
    exit.crashed = !exit.hung;
    exit.how = "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    return exit;
  }
  const std::size_t end = text.rfind(kEnd);
  exit.crashed = end == std::string::npos;
  if (exit.crashed) {
    exit.how = "it ended before its time";
  } else {
    exit.text = text.substr(0, end);
  }
  return exit;
}

}  // namespace

void Processes::start(std::size_t id, const std::function<std::string()>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process == 0) {
    close(ends[0]);
    work_and_exit(ends[1], seconds_, work);
  }
  close(ends[1]);
  running_[ends[0]] = {id, process, {}};
}

std::pair<std::size_t, Exit> Processes::next() {
  for (;;) {
    std::vector<pollfd> waiting;
    for (const auto& [file, running] : running_) waiting.push_back({file, POLLIN, 0});
    poll(waiting.data(), waiting.size(), -1);
    for (const pollfd& ready : waiting) {
      if (ready.revents == 0) continue;
      Running& running = running_[ready.fd];
      char buffer[4096];
      const ssize_t count = read(ready.fd, buffer, sizeof buffer);
      if (count > 0) {
        running.text.append(buffer, static_cast<std::size_t>(count));
        continue;
      }
      int status = 0;
      waitpid(running.process, &status, 0);
      close(ready.fd);
      std::pair<std::size_t, Exit> result{running.id, finish(running.text, status)};
      running_.erase(ready.fd);
      return result;
    }
  }
}

void Processes::run_each(std::size_t first, std::size_t count, const std::function<std::string(std::size_t)>& work,
                         const std::function<void(std::size_t, const Exit&)>& note) {
  for (std::size_t begun = 0; begun < count || !idle();) {
    if (begun < count && !full()) {
      const std::size_t index = first + begun++;
      start(index, [&work, index] { return work(index); });
      continue;
    }
    const auto [index, exit] = next();
    note(index, exit);
  }
}

Exit run_isolated(unsigned seconds, const std::function<std::string()>& work) {
  Processes one(1, seconds);
  one.start(0, work);
  return one.next().second;
}

}  // namespace attack
