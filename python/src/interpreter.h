// Letting go of the interpreter and taking it back, also while it ends: a daemon thread may be in vantage then. CPython
// up to 3.13 ends such a thread where it asks for the interpreter, by unwinding its stack. That may not pass through
// C++, where destructors are noexcept: the process would abort. So a thread that is no longer wanted waits here for the
// end of the process instead, as it does from CPython 3.14 on.
#pragma once

#include <nanobind/nanobind.h>

#include "system.h"

namespace vantage::python {

namespace nb = nanobind;

/// Whether this is no subinterpreter: objects of nanobind would be shared by all of them.
bool is_first_interpreter();

/// To be called once, when the module is imported.
void watch_interpreter();

/// Whether the interpreter is ending, and this thread not the one that ends it: it may not ask for the interpreter.
bool is_given_up();

/// Whether computations are to stop because the interpreter has ended.
bool is_ending();

/// Waits until the process ends. For a thread that is not wanted any more.
[[noreturn]] void wait_for_end() noexcept;

/// While it lives, this thread and the threads that it makes take none of the process's signals: they are the main
/// thread's, which wakes from what it waits for (say, the end of a thread) only where it takes Ctrl-C itself. A thread
/// that makes others takes what is pending (Linux: clone). Does nothing on the main thread.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  SignalSet before_;
};

/// While it lives, someone computes: the end of the interpreter waits for it, for a while.
class Computing {
 public:
  Computing();
  ~Computing();
  Computing(const Computing&) = delete;
  Computing& operator=(const Computing&) = delete;
};

/// Runs what may lose and take the interpreter: code of Python. `call` may have no objects with destructors.
template <typename Call>
auto guarded(const Call& call) {
  try {
    return call();
  } catch (...) {  // nothing in C throws: the thread is being ended
    wait_for_end();
  }
}

/// What a call of Python's C functions returns. Throws nb::python_error.
template <typename Call>
nb::object called(const Call& call) {
  PyObject* const made = guarded(call);
  if (made == nullptr) throw nb::python_error();
  return nb::steal(made);
}

/// As nb::gil_scoped_release, with a safe end.
class Released {
 public:
  Released() : state_(PyEval_SaveThread()) {}
  ~Released() {
    if (is_given_up()) wait_for_end();
    guarded([&] { PyEval_RestoreThread(state_); });
  }
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  PyThreadState* state_;
};

/// Takes the interpreter back for a moment. The thread must be wanted: see is_given_up().
class TakenBack {
 public:
  TakenBack() : state_(guarded([] { return PyGILState_Ensure(); })) {}
  ~TakenBack() { PyGILState_Release(state_); }
  TakenBack(const TakenBack&) = delete;
  TakenBack& operator=(const TakenBack&) = delete;

 private:
  PyGILState_STATE state_;
};

}  // namespace vantage::python
