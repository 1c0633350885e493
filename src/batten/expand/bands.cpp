#include "batten/expand/bands.h"

#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/expand/strength.h"
#include "batten/progress.h"

namespace batten {

std::vector<Band> octave_bands(SchemeKind kind, SeriesMatrix matrix, int count) {
  if (count < 2 || count > 12)
    throw Error(ErrorCode::BadArgument, "there are 2 to 12 bands, each with a gain, not " + std::to_string(count));
  std::vector<Band> bands;
  double shortest = 2.0;
  for (int j = 0; j + 1 < count; ++j) {
    const double longest = std::ldexp(4.0, j);
    bands.push_back({shortest, longest, passes_for(kind, matrix, 0, longest)});
    shortest = longest;
  }
  bands.push_back({shortest, std::numeric_limits<double>::infinity(), 0});
  return bands;
}

void for_each_band(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::function<void(std::size_t, const Values&)>& visit, const Progress& progress) {
  if (bands.empty()) return;
  double all = 0.0;
  for (std::size_t j = 0; j + 1 < bands.size(); ++j) {
    if (bands[j].passes <= (j > 0 ? bands[j - 1].passes : 0))
      throw Error(ErrorCode::BadArgument, "the passes of bands must rise");
    all = bands[j].passes;
  }
  Values left = values;
  int done = 0;
  for (std::size_t j = 0; j + 1 < bands.size(); ++j) {
    Values smoother = series.polynomial(left, {1.0, -1.0}, bands[j].passes - done,
                                        progress_within(progress, done / all, bands[j].passes / all));
    left -= smoother;
    visit(j, left);
    left.swap(smoother);
    done = bands[j].passes;
  }
  visit(bands.size() - 1, left);
}

Equalized equalize(const MeshSeries& series, ConstValuesRef values, const std::vector<Band>& bands,
                   const std::vector<double>& gains, const Progress& progress) {
  if (gains.size() != bands.size()) throw Error(ErrorCode::BadShape, "there must be one gain a band");
  for (const double gain : gains) {
    if (!std::isfinite(gain)) throw Error(ErrorCode::BadArgument, "a gain must be a finite number");
  }
  Equalized result{values, {}};
  const double rows = std::max<double>(1.0, static_cast<double>(values.rows()));
  const auto add = [&](std::size_t j, const Values& band) {
    const bool last = j + 1 == bands.size();
    const Eigen::RowVectorXd mean =
        last && band.rows() > 0 ? Eigen::RowVectorXd(band.colwise().mean()) : Eigen::RowVectorXd::Zero(band.cols());
    result.energies.push_back((band.rowwise() - mean).squaredNorm() / rows);
    if (gains[j] != 1.0) result.values += (gains[j] - 1.0) * (band.rowwise() - mean);
  };
  for_each_band(series, values, bands, add, progress);
  return result;
}

}  // namespace batten
