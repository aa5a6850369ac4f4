// Work in processes of its own, so that a crash or an endless loop is a finding like any other.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace attack {

struct Exit {
  std::string text;      ///< what the work returned; of no use when it died
  bool crashed = false;  ///< by a signal, or it ended before its time
  bool hung = false;     ///< it used more processor time than it had
  std::string how;       ///< "signal 11 (Segmentation fault)"
};

/// Runs up to `jobs` pieces of work at once. The process that uses this has no threads.
class Processes {
 public:
  Processes(int jobs, unsigned seconds_each) : jobs_(jobs), seconds_(seconds_each) {}

  bool full() const { return static_cast<int>(running_.size()) >= jobs_; }
  bool idle() const { return running_.empty(); }
  void start(std::size_t id, const std::function<std::string()>& work);
  /// Waits for one to end.
  std::pair<std::size_t, Exit> next();
  /// work(i) for `count` numbers from `first` on; `note` hears of each end as it comes, in no order.
  void run_each(std::size_t first, std::size_t count, const std::function<std::string(std::size_t)>& work,
                const std::function<void(std::size_t, const Exit&)>& note);

 private:
  struct Running {
    std::size_t id;
    int process;
    std::string text;
  };
  int jobs_;
  unsigned seconds_;
  std::map<int, Running> running_;  ///< by file descriptor
};

Exit run_isolated(unsigned seconds, const std::function<std::string()>& work);

}  // namespace attack
