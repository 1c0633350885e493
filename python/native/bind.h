/// \file The parts of the module.
#pragma once
#include <pybind11/pybind11.h>

namespace batten::python {

void bind_mesh(pybind11::module_& module);
void bind_interpolation(pybind11::module_& module);
void bind_surface(pybind11::module_& module);
void bind_series(pybind11::module_& module);
void bind_fit(pybind11::module_& module);
void bind_elastic(pybind11::module_& module);
void bind_medial(pybind11::module_& module);
void bind_segment(pybind11::module_& module);
#ifdef BATTEN_WITH_RENDER
void bind_render(pybind11::module_& module);
#endif

}  // namespace batten::python
