/// \file The words by which Python names the library's choices, as the tool's options do.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/expand/mesh_series.h"
#include "batten/scheme/scheme.h"
#include "batten/solve/solver.h"

namespace batten::python {

template <typename Choice>
using Words = std::vector<std::pair<const char*, Choice>>;

inline const Words<SchemeKind> kSchemes{{"catmull-clark", SchemeKind::CatmullClark},
                                        {"loop", SchemeKind::Loop},
                                        {"butterfly", SchemeKind::Butterfly},
                                        {"modified-butterfly", SchemeKind::ModifiedButterfly}};
inline const Words<BoundaryRule> kBoundaries{{"none", BoundaryRule::None},
                                             {"edge-and-corner", BoundaryRule::EdgeAndCorner},
                                             {"edge-only", BoundaryRule::EdgeOnly}};
inline const Words<SolveMethod> kMethods{{"auto", SolveMethod::Auto},
                                         {"chebyshev", SolveMethod::Chebyshev},
                                         {"conjugate-gradient", SolveMethod::ConjugateGradient},
                                         {"direct", SolveMethod::Direct},
                                         {"jacobi", SolveMethod::Jacobi},
                                         {"richardson", SolveMethod::Richardson}};
inline const Words<SeriesMatrix> kMatrices{{"limit", SeriesMatrix::Limit}, {"cotangent", SeriesMatrix::Cotangent}};

/// Throws Error(BadArgument) that lists the words.
template <typename Choice>
Choice choice_of(const std::string& word, const Words<Choice>& words, const char* what) {
  std::string all;
  for (const auto& [name, choice] : words) {
    if (word == name) return choice;
    all += all.empty() ? name : std::string(", ") + name;
  }
  throw Error(ErrorCode::BadArgument, std::string(what) + " is one of " + all + ", not '" + word + "'");
}

template <typename Choice>
const char* word_of(Choice choice, const Words<Choice>& words) {
  for (const auto& [name, value] : words) {
    if (value == choice) return name;
  }
  return "";
}

}  // namespace batten::python
