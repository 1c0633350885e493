/// \file Which surface a control mesh defines.
#pragma once
#include <optional>

#include "batten/types.h"

namespace batten {

/// The defaults are OpenSubdiv's, except for the boundary rule, whose default there is None.
struct Scheme {
  SchemeKind kind = SchemeKind::CatmullClark;
  BoundaryRule boundary = BoundaryRule::EdgeOnly;
  CreaseMethod crease_method = CreaseMethod::Uniform;
  TriangleRule triangle_rule = TriangleRule::Catmark;  ///< Catmull-Clark only
  /// Lai and Cheng's alpha in [0, 1], which acts in the first refinement step only (Catmull-Clark only). 0 is the
  /// ordinary scheme.
  double alpha = 0.0;
  /// Butterfly: the weight w of the eight-point stencil (1/2, 2 w, -w), 1/16 if not given. Modified Butterfly: the w of
  /// the ten-point stencil (1/2 - w, 1/8 + 2 w, -1/16 - w, w), 0 if not given.
  std::optional<double> tension = {};
  ButterflyBoundary butterfly_boundary = ButterflyBoundary::CreaseRules;  ///< for the two Butterflies only
  FaceVaryingRule face_varying = FaceVaryingRule::All;                    ///< Catmull-Clark and Loop only

  /// True if values at corners are linear within each face, as they always are under the Butterflies.
  bool has_linear_corners() const { return face_varying == FaceVaryingRule::All || is_interpolating(kind); }

  /// The scheme of every level after the first.
  Scheme after_first_step() const {
    Scheme scheme = *this;
    scheme.alpha = 0.0;
    return scheme;
  }
};

/// The scheme's name for messages, such as "Modified Butterfly".
constexpr const char* scheme_name(SchemeKind kind) {
  switch (kind) {
    case SchemeKind::CatmullClark:
      return "Catmull-Clark";
    case SchemeKind::Loop:
      return "Loop";
    case SchemeKind::Butterfly:
      return "Butterfly";
    case SchemeKind::ModifiedButterfly:
      break;
  }
  return "Modified Butterfly";
}

}  // namespace batten
