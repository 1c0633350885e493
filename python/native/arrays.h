/// \file NumPy arrays and the library's matrices. What is contiguous and of doubles crosses without a copy, both ways.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>

#include "batten/buffer.h"
#include "batten/error.h"
#include "batten/types.h"

namespace batten::python {

namespace py = pybind11;

/// Numbers as C-contiguous doubles: the array itself where it is that already, else a copy.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<Index, py::array::c_style | py::array::forcecast>;

/// A matrix of an array's numbers; one dimension is one column. The array must outlive it. Throws Error(BadShape).
inline Eigen::Map<const Values> rows_of(const Doubles& array, const char* what = "the values") {
  if (array.ndim() != 1 && array.ndim() != 2) {
    throw Error(ErrorCode::BadShape, std::string(what) + " must be an array of one or two dimensions, not of " +
                                         std::to_string(array.ndim()));
  }
  return {array.data(), array.shape(0), array.ndim() == 2 ? array.shape(1) : 1};
}

/// The same of points. Throws Error(BadShape) unless there are three columns.
inline Eigen::Map<const Values> points_of(const Doubles& array, const char* what = "points") {
  const Eigen::Map<const Values> rows = rows_of(array, what);
  if (array.ndim() != 2 || rows.cols() != 3) {
    throw Error(ErrorCode::BadShape, std::string(what) + " must be an array of shape (n, 3)");
  }
  return rows;
}

/// The memory of `owner`, which the array keeps, as an array of the shape.
template <typename Number, typename Owner>
py::array_t<Number> array_over(Owner&& owner, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::remove_reference_t<Owner>>(std::forward<Owner>(owner));
  const Number* const data = kept->data();
  py::capsule keeper(kept.get(), [](void* memory) { delete static_cast<std::remove_reference_t<Owner>*>(memory); });
  kept.release();
  return py::array_t<Number>(std::move(shape), data, keeper);
}

template <typename Matrix>
py::array_t<double> array_of(Matrix&& matrix) {
  const py::ssize_t rows = matrix.rows();
  const py::ssize_t cols = matrix.cols();
  if constexpr (std::remove_reference_t<Matrix>::ColsAtCompileTime == 1) {
    return array_over<double>(std::forward<Matrix>(matrix), {rows});
  } else {
    return array_over<double>(std::forward<Matrix>(matrix), {rows, cols});
  }
}

template <typename Number>
py::array_t<Number> array_of(Buffer<Number>&& buffer) {
  const auto size = static_cast<py::ssize_t>(buffer.size());
  return array_over<Number>(std::move(buffer), {size});
}

}  // namespace batten::python
