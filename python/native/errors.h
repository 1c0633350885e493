/// \file The library's errors as batten.Error, in each of the package's modules.
#pragma once
#include <pybind11/pybind11.h>

#include <array>

#include "batten/error.h"

namespace batten::python {

/// In the order of ErrorCode.
inline constexpr std::array kCodes{
    "bad-argument",  "bad-shape",         "not-finite",          "index-out-of-range", "degenerate-face",
    "repeated-face", "non-manifold-edge", "non-manifold-vertex", "inconsistent-faces", "non-orientable",
    "not-triangles", "singular-system",   "not-converged",       "file-not-readable",  "file-not-writable",
    "bad-file",      "unknown-format",    "too-large",           "cancelled",          "not-available"};
static_assert(kCodes.size() == static_cast<std::size_t>(ErrorCode::NotAvailable) + 1);

/// Adds set_error_type(batten.Error) to a module, and from then on raises that for Error.
void translate_errors(pybind11::module_& module);

}  // namespace batten::python
