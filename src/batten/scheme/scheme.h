/// \file Which surface a control mesh stands for.
#pragma once
#include "batten/types.h"

namespace batten {

/// The defaults are OpenSubdiv's, but for the boundary: its own is None.
struct Scheme {
  SchemeKind kind = SchemeKind::CatmullClark;
  BoundaryRule boundary = BoundaryRule::EdgeOnly;
  CreaseMethod crease_method = CreaseMethod::Uniform;
  TriangleRule triangle_rule = TriangleRule::Catmark;  ///< Catmull-Clark only
  /// Lai and Cheng's alpha in [0, 1], in the first refinement step only (Catmull-Clark only); 0 is the ordinary scheme.
  double alpha = 0.0;

  /// The scheme of every level after the first.
  Scheme after_first_step() const {
    Scheme scheme = *this;
    scheme.alpha = 0.0;
    return scheme;
  }
};

}  // namespace batten
