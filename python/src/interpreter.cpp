#include "interpreter.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace vantage::python {
namespace {

/// Computations hear of the end within 0.2 s (docs/architecture.md). What tells no progress may take longer: it is
/// left alone then.
constexpr auto kPatience = std::chrono::seconds(5);

std::atomic<unsigned long> main_thread = 0;
std::atomic<int> computing = 0;
std::atomic<bool> ends = false;

bool is_finalizing() {
#ifdef Py_LIMITED_API
  // In the stable ABI since Python 3.13; Python 3.12 has it under the other name.
  using Asked = int (*)();
  static const auto asked = [] {
    void* found = function_of_python("Py_IsFinalizing");
    if (found == nullptr) found = function_of_python("_Py_IsFinalizing");
    return reinterpret_cast<Asked>(found);
  }();
  return asked != nullptr && asked() != 0;
#elif PY_VERSION_HEX >= 0x030d0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

/// After this the process destroys what computations use.
void stop_computations() {
  ends = true;
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (computing > 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// A forked process has one thread, which is its main one, and no computations.
void begin_anew() {
  main_thread = PyThread_get_thread_ident();
  computing = 0;
}

}  // namespace

bool is_first_interpreter() { return PyInterpreterState_GetID(PyInterpreterState_Get()) == 0; }

void watch_interpreter() {
  main_thread = nb::cast<unsigned long>(nb::module_::import_("threading").attr("main_thread")().attr("ident"));
  at_fork(begin_anew);
  Py_AtExit(stop_computations);
}

bool is_given_up() { return is_finalizing() && PyThread_get_thread_ident() != main_thread; }

bool is_ending() { return ends; }

void wait_for_end() noexcept {
  while (true) wait_for_long();
}

HeldSignals::HeldSignals() : before_(hold_signals(PyThread_get_thread_ident() != main_thread)) {}

HeldSignals::~HeldSignals() { restore_signals(before_); }

Computing::Computing() { ++computing; }
Computing::~Computing() { --computing; }

}  // namespace vantage::python
