#include "core/system_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>

namespace vantage::internal::core {
namespace {

/// While one lives, signals that ask to end wait.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t held;
    sigemptyset(&held);  // macros on macOS
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held, signal);
    ::pthread_sigmask(SIG_BLOCK, &held, &old_);
  }
  ~HeldSignals() { ::pthread_sigmask(SIG_SETMASK, &old_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t old_{};
};

int mode_of(Access wanted) {
  switch (wanted) {
    case Access::read:
      return R_OK;
    case Access::write:
      return W_OK;
    case Access::make_files_in:
      return W_OK | X_OK;
  }
  return R_OK;
}

}  // namespace

int access_error(const std::filesystem::path& path, Access wanted) {
  return ::access(path.c_str(), mode_of(wanted)) == 0 ? 0 : errno;
}

int open_to_read(const std::filesystem::path& file) { return ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }

int synchronise(int descriptor) { return ::fsync(descriptor) == 0 ? 0 : errno; }

void synchronise_folder(const std::filesystem::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  (void)::fsync(handle);
  ::close(handle);
}

void copy_permissions(const std::filesystem::path& from, int to_descriptor) {
  struct stat status {};
  if (::stat(from.c_str(), &status) == 0) (void)::fchmod(to_descriptor, status.st_mode & 07777);
}

void with_signals_held(const std::function<void()>& step) {
  const HeldSignals held;
  step();
}

/// As much as the control group (a container, a batch job) may use; version 2, "max" for all.
double memory_bytes() {
  const double machine = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  double group = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> group ? std::min(machine, group) : machine;
}

}  // namespace vantage::internal::core
