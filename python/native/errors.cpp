#include "native/errors.h"

namespace batten::python {

namespace py = pybind11;

namespace {

PyObject* error_type = nullptr;  // batten.Error

void raise(const Error& error) {
  const py::object raised =
      py::reinterpret_borrow<py::object>(error_type)(error.what(), kCodes[static_cast<std::size_t>(error.code())]);
  PyErr_SetObject(error_type, raised.ptr());
}

}  // namespace

void translate_errors(py::module_& module) {
  module.def("set_error_type", [](const py::object& type) { error_type = py::object(type).release().ptr(); });
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      raise(error);
    }
  });
}

}  // namespace batten::python
