// Errors of C++ as exceptions of Python.
#pragma once

#include <nanobind/nanobind.h>

#include "vantage/error.h"

namespace vantage::python {

namespace nb = nanobind;

/// What vantage._errors.make(kind, code, problem, where, fix, object) returns.
nb::object python_error(const Error& error);

}  // namespace vantage::python
