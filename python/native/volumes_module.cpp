/// Files of volumes for the package `batten`: a module of its own, so that ITK is loaded where a file is read or
/// written.
#include <pybind11/pybind11.h>

#include <string>

#include "batten/volume/volume_file.h"
#include "native/errors.h"
#include "native/voxels.h"

namespace py = pybind11;

namespace batten::python {

namespace {

py::tuple read(const std::string& path) {
  return arrays_of([&] {
    const py::gil_scoped_release unlocked;
    return read_volume(path);
  }());
}

void write(const std::string& path, const Voxels& values, const Doubles& affine, bool bytes) {
  const Volume volume = volume_of(values, affine);
  const py::gil_scoped_release unlocked;
  write_volume(path, volume, bytes ? VoxelType::Byte : VoxelType::Float);
}

}  // namespace

}  // namespace batten::python

PYBIND11_MODULE(_volumes, module) {
  module.doc() = "Files of volumes, by ITK.";
  batten::python::translate_errors(module);
  module.def("read", &batten::python::read);
  module.def("write", &batten::python::write);
}
