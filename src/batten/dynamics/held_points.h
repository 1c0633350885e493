/// \file Supports as a step's system needs them: which control points are free, and the rows of the pins.
#pragma once
#include "batten/buffer.h"
#include "batten/dynamics/force.h"
#include "batten/dynamics/supports.h"

namespace batten {

/// Where supports lead at a time.
struct HeldPlaces {
  Points points;  ///< V-by-3, those of fixed control points; others are not set
  Points pins;    ///< a row a pin
};

class HeldPoints {
 public:
  /// Control points of vertices without a face stay as they are. Throws Error(IndexOutOfRange, BadArgument) for
  /// supports that do not exist, and for control points that are fixed twice.
  HeldPoints(const ElasticSurface& surface, const Supports& supports);

  const Buffer<Index>& free() const { return free_; }  ///< ascending
  const PlaceRows& pins() const { return pins_; }
  Index pin_count() const { return static_cast<Index>(pins_.rows.rows()); }

  /// Throws Error(NotFinite) naming the support whose path is not finite.
  HeldPlaces at(double time) const;
  /// Moves the fixed control points to their places; others stay.
  void lead(const HeldPlaces& places, Points& positions) const;
  /// What of a force on the free control points pins can balance: the part that J^T spans.
  Points reaction(const Points& force) const;
  /// How far the farthest support is from its place.
  double error(const HeldPlaces& places, const Points& positions) const;

 private:
  Supports supports_;
  Index vertex_count_;
  Buffer<Index> free_;
  PlaceRows pins_;
};

}  // namespace batten
