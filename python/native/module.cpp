/// The native part of the package `batten`: the library's functions on arrays. What a user sees is in python/batten.
#include <pybind11/pybind11.h>

#include <array>

#include "batten/error.h"
#include "batten/parallel/threads.h"
#include "native/bind.h"

namespace py = pybind11;

namespace {

/// In the order of batten::ErrorCode.
constexpr std::array kCodes{"bad-argument",       "bad-shape",         "not-finite",        "index-out-of-range",
                            "degenerate-face",    "repeated-face",     "non-manifold-edge", "non-manifold-vertex",
                            "inconsistent-faces", "non-orientable",    "not-triangles",     "singular-system",
                            "not-converged",      "file-not-readable", "file-not-writable", "bad-file",
                            "unknown-format",     "too-large",         "cancelled",         "not-available"};
static_assert(kCodes.size() == static_cast<std::size_t>(batten::ErrorCode::NotAvailable) + 1);

PyObject* error_type = nullptr;  // batten.Error

void raise(const batten::Error& error) {
  const py::object raised =
      py::reinterpret_borrow<py::object>(error_type)(error.what(), kCodes[static_cast<std::size_t>(error.code())]);
  PyErr_SetObject(error_type, raised.ptr());
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  module.doc() = "The native part of batten.";
  module.def("set_error_type", [](const py::object& type) { error_type = py::object(type).release().ptr(); });
  module.def("code_of", [](int kind) { return kCodes.at(static_cast<std::size_t>(kind)); });
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const batten::Error& error) {
      raise(error);
    }
  });
  module.def("thread_count", [] { return batten::thread_count(); });
  batten::python::bind_mesh(module);
  batten::python::bind_interpolation(module);
  batten::python::bind_surface(module);
  batten::python::bind_series(module);
  batten::python::bind_fit(module);
  batten::python::bind_elastic(module);
  batten::python::bind_medial(module);
#ifdef BATTEN_WITH_RENDER
  batten::python::bind_render(module);
#endif
}
