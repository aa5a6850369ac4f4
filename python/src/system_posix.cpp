#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <initializer_list>

#include "system.h"

namespace vantage::python {

SignalSet hold_signals(bool all) {
  sigset_t held, before = {};
  sigemptyset(&held);
  if (all) {
    sigfillset(&held);
    for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS}) sigdelset(&held, own);
  }
  pthread_sigmask(SIG_BLOCK, &held, &before);
  return before;
}

void restore_signals(const SignalSet& before) { pthread_sigmask(SIG_SETMASK, &before, nullptr); }

void* function_of_python(const char* name) { return dlsym(RTLD_DEFAULT, name); }

void at_fork(void (*begin_anew)()) { pthread_atfork(nullptr, nullptr, begin_anew); }

void wait_for_long() { pause(); }

}  // namespace vantage::python
