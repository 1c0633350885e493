/// \file Places on all faces of a surface at which forces act: their points and derivatives for any control points, and
/// the way back from forces there to forces on the control points.
///
/// Faces with the same surroundings share a table of weights (energy/jet_tables.h). Values at places stand in one
/// matrix, face by face, place by place: the point alone, or point, du and dv.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "batten/dynamics/force.h"
#include "batten/energy/face_elements.h"
#include "batten/energy/jet_tables.h"

namespace batten {

/// What is known of a place: one row of numbers, or three.
enum class SampleRows { Point = 1, PointDuDv = 3 };

/// Places inside each face and what they count, of du dv.
struct GaussSamples {
  QuadratureOptions quadrature;
};
/// The corners of `intervals` by `intervals` equal parts of each face. They count as the trapezoidal rule says: 1 in
/// all on each face. Corners of the face stand a millionth of a side inside, where all surfaces have derivatives.
struct GridSamples {
  int intervals = 2;
};

/// Const and safe from several threads; results have the same bits for any number of threads. Build: a microsecond a
/// face. Memory: 250 bytes a regular face.
class SurfaceSamples {
 public:
  /// Throws Error(BadArgument) for the Butterflies and options out of range, Error(TooLarge) as FaceElements does.
  SurfaceSamples(const SurfacePatches& patches, const GaussSamples& rule, SampleRows rows = SampleRows::PointDuDv);
  SurfaceSamples(const SurfacePatches& patches, const GridSamples& rule, SampleRows rows = SampleRows::Point);

  const SurfacePatches& patches() const { return patches_; }
  int rows() const { return rows_; }
  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(starts_.back()); }

  /// Faces that are no holes, in their order, and where their places begin.
  const FaceElements& elements() const { return elements_; }
  std::ptrdiff_t begin(Index element) const { return static_cast<std::ptrdiff_t>(starts_[element]); }
  std::ptrdiff_t end(Index element) const { return static_cast<std::ptrdiff_t>(starts_[element + 1]); }
  const JetTable& table(Index element) const { return tables_[elements_.kind(element)]; }

  Index element_of(std::ptrdiff_t sample) const;
  SurfacePlace place(std::ptrdiff_t sample) const;
  double weight(std::ptrdiff_t sample) const;

  /// Control points of the base, which the elements' vertices are.
  Points base_points(const Points& control) const;
  /// The rows of one element's places. base: as base_points() gives. result: three numbers a row, rows() for each
  /// place.
  void evaluate_element(Index element, const Points& base, double* result) const;
  /// Those of all: rows() * count() of them.
  Points evaluate(const Points& control) const;
  /// The transposed map: the sum over all rows of weights^T force, V-by-3. forces: as evaluate() gives, or of the
  /// points alone, count() rows.
  Points pull_back(const Points& forces) const;

  /// The rows of the points of some places.
  std::shared_ptr<const PlaceRows> point_rows(std::span<const std::ptrdiff_t> samples) const;

 private:
  SurfaceSamples(const SurfacePatches& patches, SampleRows rows);
  void list_places();

  SurfacePatches patches_;
  int rows_;
  FaceElements elements_;
  std::vector<JetTable> tables_;
  Buffer<std::size_t> starts_;
  /// Weights of control points of each base point, and transposed, where the base is a first refinement.
  std::optional<PlaceRows> base_rows_;
};

/// |du x dv| times the sample's weight, of each place: they sum to the area. jets: of PointDuDv.
Scalars sample_areas(const SurfaceSamples& samples, const Points& jets);

/// The area of each element of the surface with these control points, by Gauss points.
Scalars element_areas(const SurfacePatches& patches, const Points& control);

}  // namespace batten
