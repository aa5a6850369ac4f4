#include <Python.h>

#include "system.h"

#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>

namespace vantage::python {

SignalSet hold_signals(bool) { return {}; }
void restore_signals(const SignalSet&) {}

/// Of the library of the interpreter's version, python312.dll: python3.dll hands on what is in the stable ABI alone.
void* function_of_python(const char* name) {
  static const HMODULE library = [] {
    HMODULE found = nullptr;
    const auto address = reinterpret_cast<LPCWSTR>(reinterpret_cast<void*>(&Py_IsInitialized));
    const DWORD how = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    return GetModuleHandleExW(how, address, &found) ? found : nullptr;
  }();
  return library == nullptr ? nullptr : reinterpret_cast<void*>(GetProcAddress(library, name));
}

void at_fork(void (*)()) {}  // Windows has no fork

void wait_for_long() { Sleep(INFINITE); }

}  // namespace vantage::python
