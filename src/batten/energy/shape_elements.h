/// \file The matrices of a shape energy on single faces, four faces at a time.
#pragma once
#include <array>
#include <span>

#include "batten/buffer.h"
#include "batten/energy/face_elements.h"
#include "batten/energy/jet_tables.h"
#include "batten/energy/shape_rows.h"
#include "batten/types.h"

namespace batten {

/// Elements of one kind that follow each other, in the lanes of vectors. Lanes beyond `count` repeat the last one.
struct ShapeBatch {
  Index first;
  int count;  ///< 1 to 4
};

/// Calls visit(batch) for elements begin to end.
template <typename Visit>
void for_shape_batches(const FaceElements& elements, Index begin, Index end, const Visit& visit) {
  while (begin < end) {
    int count = 1;
    while (count < 4 && begin + count < end && elements.kind(begin + count) == elements.kind(begin)) ++count;
    visit(ShapeBatch{begin, count});
    begin += count;
  }
}

/// What a batch needs room for; one for each thread.
struct ShapeScratch {
  Buffer<Double4> points;
  Buffer<Double4> forms;
  Buffer<Double4> sums;
};

/// Where the numbers of each element of a batch go; those beyond its count are not looked at.
using ShapeTargets = std::array<double*, 4>;

/// The lengths that a face has in `reference`, and its surface, by tables of the elements' kinds. Refers to what it is
/// given.
class ShapeElements {
 public:
  ShapeElements(ShapeEnergyKind kind, const FaceElements& elements, const std::vector<JetTable>& tables,
                ConstValuesRef reference)
      : kind_(kind), elements_(elements), tables_(tables), reference_(reference) {}

  /// matrix: n^2 numbers for n vertices, row by row; symmetric to the last bit.
  void matrices(const ShapeBatch& batch, ShapeScratch& scratch, const ShapeTargets& matrix) const;
  /// The energy of each element's surface in its own lengths.
  Double4 energies(const ShapeBatch& batch, ShapeScratch& scratch) const;
  /// Adds the matrix times the reference itself to `gradient`, three numbers a vertex, without the matrix.
  void gradients(const ShapeBatch& batch, ShapeScratch& scratch, const ShapeTargets& gradient) const;

 private:
  const JetTable& gather(const ShapeBatch& batch, ShapeScratch& scratch) const;

  ShapeEnergyKind kind_;
  const FaceElements& elements_;
  const std::vector<JetTable>& tables_;
  ConstValuesRef reference_;
};

}  // namespace batten
