/// \file Schemes that differ from the default in a choice or two.
#pragma once
#include "batten/scheme/scheme.h"

namespace batten::test {

inline Scheme scheme_of(SchemeKind kind) {
  Scheme scheme;
  scheme.kind = kind;
  return scheme;
}

inline const Scheme kCatmullClark = scheme_of(SchemeKind::CatmullClark);
inline const Scheme kLoop = scheme_of(SchemeKind::Loop);

inline Scheme scheme_of(SchemeKind kind, BoundaryRule boundary) {
  Scheme scheme = scheme_of(kind);
  scheme.boundary = boundary;
  return scheme;
}

inline Scheme scheme_of(SchemeKind kind, ButterflyBoundary boundary) {
  Scheme scheme = scheme_of(kind);
  scheme.butterfly_boundary = boundary;
  return scheme;
}

}  // namespace batten::test
