// What the binding asks the system for: system_posix.cpp, system_windows.cpp.
#pragma once

#ifndef _WIN32
#include <csignal>
#endif

namespace vantage::python {

#ifdef _WIN32
struct SignalSet {};  // Windows runs the handler of Ctrl-C in a thread of its own
#else
using SignalSet = sigset_t;
#endif

/// Where `all` is set, the thread takes no more signals, but for those of what it does itself. What it took before.
SignalSet hold_signals(bool all);
void restore_signals(const SignalSet& before);

/// A function of the interpreter that this process runs; null where it has none of that name.
void* function_of_python(const char* name);

/// Calls a function in each process that is forked from this one.
void at_fork(void (*begin_anew)());

/// Returns now and then.
void wait_for_long();

}  // namespace vantage::python
