/// \file Splits a mesh into bands, from its finest bumps to its overall shape, and scales them one by one.
#pragma once
#include <functional>
#include <vector>

#include "batten/expand/mesh_series.h"

namespace batten {

/// One band: bumps of `shortest` to `longest` edge lengths. At these two lengths half of a bump is in the band.
struct Band {
  double shortest = 0.0;
  double longest = 0.0;  ///< infinite for the last band, which has the overall shape
  int passes = 0;        ///< the number of applications of A after which only bumps longer than `longest` are left
};

/// Bands by octaves: the first has bumps up to 4 edge lengths, the next ones 4 to 8, 8 to 16 and so on, the last the
/// rest.
/// Throws Error(BadArgument) unless 2 <= count <= 12.
std::vector<Band> octave_bands(SchemeKind kind, SeriesMatrix matrix, int count);

/// Calls visit(band, values) for each band, finest first. Band j is A^p_(j-1) M - A^p_j M, where p_j are the bands'
/// passes and p_(-1) = 0; the last band is the remainder. The bands add up to the values M, to rounding. Corners and
/// kept vertices are in the last band only. Throws Error: BadShape, NotFinite, BadArgument (passes that do not
/// increase), Cancelled.
void for_each_band(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::function<void(std::size_t, const Values&)>& visit, const Progress& progress = {});

/// The values after each band is multiplied by its gain. The last band is scaled about its mean. Gains of 1 change no
/// bit.
struct Equalized {
  Values values;
  /// For each band before scaling: the mean over the vertices of the squared length; the last band's about its mean.
  std::vector<double> energies;
};
/// gains: one for each band, finite. Throws Error(BadShape, BadArgument) and what for_each_band throws.
Equalized equalize(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::vector<double>& gains, const Progress& progress = {});

}  // namespace batten
