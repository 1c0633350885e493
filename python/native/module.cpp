/// The native part of the package `batten`: the library's functions on arrays. What a user sees is in python/batten.
#include <pybind11/pybind11.h>

#include "batten/parallel/threads.h"
#include "native/bind.h"
#include "native/errors.h"

PYBIND11_MODULE(_native, module) {
  module.doc() = "The native part of batten.";
  batten::python::translate_errors(module);
  module.def("code_of", [](int kind) { return batten::python::kCodes.at(static_cast<std::size_t>(kind)); });
  module.def("thread_count", [] { return batten::thread_count(); });
  batten::python::bind_mesh(module);
  batten::python::bind_interpolation(module);
  batten::python::bind_surface(module);
  batten::python::bind_series(module);
  batten::python::bind_fit(module);
  batten::python::bind_elastic(module);
  batten::python::bind_medial(module);
  batten::python::bind_segment(module);
#ifdef BATTEN_WITH_RENDER
  batten::python::bind_render(module);
#endif
}
