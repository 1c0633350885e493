/// \file Summaries of distances as Python's dictionaries.
#pragma once
#include <pybind11/pybind11.h>

#include "batten/nearest/distance_summary.h"

namespace batten::python {

inline pybind11::dict dict_of(const DistanceSummary& summary) {
  pybind11::dict result;
  result["max"] = summary.max;
  result["max_point"] = summary.max_point;
  result["rms"] = summary.rms;
  result["mean"] = summary.mean;
  result["median"] = summary.median;
  result["most_of_95"] = summary.most_of_95;
  result["most_of_99"] = summary.most_of_99;
  return result;
}

}  // namespace batten::python
