#include "errors.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <vector>

#include "bindings.h"
#include "common/shown_address.h"
#include "interpreter.h"
#include "vantage/error.h"

namespace vantage::python {
namespace {

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
      return "input";
    case ErrorKind::output:
      return "output";
    case ErrorKind::cancelled:
      return "cancelled";
    case ErrorKind::internal:
      return "internal";
  }
  return "internal";
}

}  // namespace

nb::object python_error(const Error& error) {
  const nb::object object = error.object() ? nb::cast(*error.object()) : nb::none();
  const nb::tuple told = nb::make_tuple(name_of(error.kind()), vantage::name_of(error.code()), error.problem(),
                                        error.where(), error.fix(), object);
  const nb::object module = called([] { return PyImport_ImportModule("vantage._errors"); });
  const nb::object make = module.attr("make");
  return called([&] { return PyObject_CallObject(make.ptr(), told.ptr()); });
}

namespace {

/// An Error of C++ becomes one of Python.
void translate(const std::exception_ptr& pointer, void*) {
  if (!pointer) wait_for_end();  // no exception of C++: the thread is being ended
  try {
    std::rethrow_exception(pointer);
  } catch (const Error& error) {
    const nb::object made = python_error(error);
    PyErr_SetObject(made.type().ptr(), made.ptr());
  }
}

}  // namespace

void bind_errors(nb::module_& module) {
  nb::register_exception_translator(translate);
  module.def("error_codes", [] {
    std::vector<std::string> names;
    for (const ErrorCode code : error_codes()) names.emplace_back(vantage::name_of(code));
    return names;
  });
  module.def("warning_codes", [] {
    std::vector<std::string> names;
    for (const WarningCode code : warning_codes()) names.emplace_back(vantage::name_of(code));
    return names;
  });
  module.def(
      "without_secrets",
      [](const nb::bytes& text, bool is_address) {  // bytes: names of files may be no UTF-8
        const std::string shown = without_secrets({text.c_str(), text.size()}, is_address);
        return nb::bytes(shown.data(), shown.size());
      },
      nb::arg("text"), nb::arg("is_address"));
}

}  // namespace vantage::python
