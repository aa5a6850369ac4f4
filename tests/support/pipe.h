// A named pipe that nobody writes to: whoever opens it for reading waits for ever.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <utility>

namespace vantage::testing {

/// Whoever opens it is let go, with nothing to read, and noted.
class Pipe {
 public:
  explicit Pipe(std::filesystem::path file) : file_(std::move(file)) {
    if (::mkfifo(file_.c_str(), 0600) != 0) throw std::runtime_error("cannot make " + file_.string());
    watch_ = std::thread([this] {
      while (!is_over_) {
        const int opened = ::open(file_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);  // works where there is a reader
        if (opened >= 0) {
          was_opened_ = true;
          ::close(opened);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    is_over_ = true;
    watch_.join();
  }

  const std::filesystem::path& file() const { return file_; }
  bool was_opened() const { return was_opened_; }

 private:
  std::filesystem::path file_;
  std::atomic<bool> was_opened_ = false, is_over_ = false;
  std::thread watch_;
};

}  // namespace vantage::testing
