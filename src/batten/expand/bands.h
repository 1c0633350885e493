/// \file A mesh in bands, from its finest bumps to its overall shape, and an equaliser for them.
#pragma once
#include <functional>
#include <vector>

#include "batten/expand/mesh_series.h"

namespace batten {

/// One band: bumps of `shortest` to `longest` edge lengths; they fade in and out by halves at these lengths.
struct Band {
  double shortest = 0.0;
  double longest = 0.0;  ///< infinite for the last band, which has the overall shape
  int passes = 0;        ///< of A behind which `longest` and all that is longer is left
};

/// Octaves: the first band has bumps up to 4 edge lengths, the next ones 4 to 8, 8 to 16, .., the last one the rest.
/// Throws Error(BadArgument) unless 2 <= count <= 12.
std::vector<Band> octave_bands(SchemeKind kind, SeriesMatrix matrix, int count);

/// Calls visit(band, values) for each band, finest first. Band j is A^p_(j-1) M - A^p_j M, p the bands' passes, and
/// p_(-1) = 0; the last one is what is left. They add up to the values M to rounding. Corners and kept vertices are in
/// the last band only. Throws Error: BadShape, NotFinite, BadArgument (passes that do not rise), Cancelled.
void for_each_band(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::function<void(std::size_t, const Values&)>& visit, const Progress& progress = {});

/// The values with each band times its gain; gains of 1 leave every bit. The last band's gain is about its mean.
struct Equalized {
  Values values;
  std::vector<double>
      energies;  ///< of each band as given: mean over the vertices of the squared length; the last about its mean
};
/// gains: one a band, finite. Throws Error(BadShape, BadArgument) and what for_each_band throws.
Equalized equalize(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::vector<double>& gains, const Progress& progress = {});

}  // namespace batten
