/// \file Jets of a face as rows of weights of the points around it, the same for all faces with the same surroundings.
#pragma once
#include <Eigen/Core>
#include <span>

#include "batten/patch/ring_types.h"

namespace batten {

/// A derivative, or the value itself.
enum class JetRow { Value, Du, Dv, Duu, Duv, Dvv, Duuu, Duuv, Duvv, Dvvv };

/// How many times it is differentiated.
constexpr int order_of(JetRow row) {
  return row == JetRow::Value ? 0 : row <= JetRow::Dv ? 1 : row <= JetRow::Dvv ? 2 : 3;
}

/// A row for each JetRow that was asked for, a column for each point.
using FaceJet = Eigen::MatrixXd;

/// The jet at (u, v) of a face of a ring type, by the ring's points, or of a regular face (RingTypes::kPatch), by all
/// points of its patch. Rows of derivatives sum to 0. False, and nothing, at an irregular vertex itself. Rounding of a
/// derivative: that divided by the distance to the nearest corner, once an order beyond the first.
/// O(rows halvings size of the ring's step).
bool face_jet(bool quads, const RingTypes& types, Index type, double u, double v, std::span<const JetRow> rows,
              FaceJet& jet);

}  // namespace batten
