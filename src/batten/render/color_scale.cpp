#include "batten/render/color_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "batten/error.h"
#include "batten/quantile.h"
#include "batten/render/srgb.h"

namespace batten {
namespace {

// Every eighth colour of viridis and every sixteenth of the cool to warm map, as sRGB bytes.
constexpr unsigned char kSequential[][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                            {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                            {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
constexpr unsigned char kDiverging[][3] = {
    {59, 76, 192},   {77, 104, 215},  {98, 130, 234},  {119, 154, 247}, {141, 176, 254}, {163, 194, 255},
    {184, 208, 249}, {204, 217, 238}, {221, 221, 221}, {236, 211, 197}, {245, 196, 173}, {247, 177, 148},
    {244, 154, 123}, {236, 127, 99},  {222, 96, 77},   {203, 62, 56},   {180, 4, 38}};
constexpr Color kMissing{0.35F, 0.35F, 0.35F};

template <std::size_t N>
Color between(const unsigned char (&table)[N][3], double position) {
  const double place = std::clamp(position, 0.0, 1.0) * (N - 1);
  const auto first = std::min(static_cast<std::size_t>(place), N - 2);
  const auto share = static_cast<float>(place - static_cast<double>(first));
  Color color;
  for (std::size_t c = 0; c < 3; ++c) {
    const float mixed = (1.0F - share) * table[first][c] + share * table[first + 1][c];
    color[c] = render_detail::decode_srgb(mixed / 255.0F);
  }
  return color;
}

void fit_log(std::vector<double>& values, double outliers, ColorScale& scale) {
  constexpr double kMostRange = 1e6;
  std::erase_if(values, [](double value) { return value <= 0.0; });
  scale.high = quantile(values, 1.0 - outliers);
  scale.low = std::max(quantile(values, outliers), scale.high / kMostRange);
  if (scale.high <= scale.low * 1.01) {
    scale.low /= 2.0;
    scale.high *= 2.0;
  }
}

/// The ends of a bar with a middle, from the ends of the numbers; one side only if all numbers are there.
void fit_diverging(double middle, ColorScale& scale) {
  constexpr double kNear = 0.3;
  const double above = scale.high - middle;
  const double below = middle - scale.low;
  if (below <= 0.0 && above > 0.0) {
    scale.map = ColorMap::Warm;
    if (-below < kNear * above) scale.low = middle;
  } else if (above <= 0.0 && below > 0.0) {
    scale.map = ColorMap::Cool;
    if (-above < kNear * below) scale.high = middle;
  } else {
    const double reach = std::max(above, below);
    scale.low = middle - reach;
    scale.high = middle + reach;
  }
}

/// The least and the greatest of the numbers, but for the outliers; all of them where nothing else differs.
std::array<double, 2> linear_range(std::vector<double>& values, const ScaleRequest& request, const ColorScale& all) {
  const std::array<double, 2> most{quantile(values, request.outliers), quantile(values, 1.0 - request.outliers)};
  const double size = std::max(std::abs(all.lowest), std::abs(all.highest));
  const bool equal = !(most[1] - most[0] > 1e-9 * size);
  return equal && !request.whole ? std::array<double, 2>{all.lowest, all.highest} : most;
}

void fit_linear(std::vector<double>& values, const ScaleRequest& request, ColorScale& scale) {
  const std::array<double, 2> range = linear_range(values, request, scale);
  scale.low = range[0];
  scale.high = range[1];
  if (request.map != ColorMap::Diverging && scale.lowest >= 0.0 && scale.low < 0.3 * scale.high) scale.low = 0.0;
  if (request.map == ColorMap::Diverging) fit_diverging(request.middle, scale);
  // The bar must have a length. Differences due to rounding do not count.
  const double size = std::max({std::abs(scale.low), std::abs(scale.high), std::numeric_limits<double>::min()});
  if (scale.high - scale.low > 1e-9 * size) return;
  const double reach = request.whole || scale.high == 0.0 ? 1.0 : 0.5 * std::abs(scale.high);
  const double centre = scale.high;
  const bool both_sides = scale.map == ColorMap::Diverging;
  scale.low = !both_sides && centre >= 0.0 ? std::max(0.0, centre - reach) : centre - reach;
  scale.high = centre + reach;
}

/// Numbers are counted as beyond an end by more than rounding only.
void count_beyond(const std::vector<double>& values, ColorScale& scale) {
  const double slack = 1e-9 * (scale.high - scale.low);
  std::ptrdiff_t below = 0;
  std::ptrdiff_t above = 0;
  for (const double value : values) {
    below += value < scale.low - slack ? 1 : 0;
    above += value > scale.high + slack ? 1 : 0;
  }
  scale.share_below = static_cast<double>(below) / static_cast<double>(values.size());
  scale.share_above = static_cast<double>(above) / static_cast<double>(values.size());
}

void require_range(const std::array<double, 2>& range) {
  const bool ascends = std::isfinite(range[0]) && std::isfinite(range[1]) && range[0] < range[1];
  if (!ascends) throw Error(ErrorCode::BadArgument, "a range of colours needs two finite numbers, the smaller first");
}

}  // namespace

Color map_color(ColorMap map, double position) {
  if (std::isnan(position)) return kMissing;
  if (map == ColorMap::Cool) return between(kDiverging, 0.5 * std::clamp(position, 0.0, 1.0));
  if (map == ColorMap::Sequential) return between(kSequential, position);
  return between(kDiverging, map == ColorMap::Warm ? 0.5 + 0.5 * std::clamp(position, 0.0, 1.0) : position);
}

double ColorScale::position(double value) const {
  if (std::isnan(value)) return value;
  if (!log) return std::clamp((value - low) / (high - low), 0.0, 1.0);
  return value <= low ? 0.0 : std::min(std::log(value / low) / std::log(high / low), 1.0);
}

ColorScale fit_color_scale(const Eigen::Ref<const Scalars>& values, const ScaleRequest& request) {
  if (!(request.outliers >= 0.0 && request.outliers <= 0.4))
    throw Error(ErrorCode::BadArgument, "the share of outliers must be 0 to 0.4");
  if (request.range) require_range(*request.range);
  ColorScale scale;
  scale.map = request.map;
  scale.title = request.title;
  scale.unit = request.unit;
  scale.whole = request.whole;
  std::vector<double> finite;
  for (const double value : values) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  if (finite.empty()) finite.push_back(request.middle);
  scale.lowest = *std::min_element(finite.begin(), finite.end());
  scale.highest = *std::max_element(finite.begin(), finite.end());
  scale.log = request.map != ColorMap::Diverging && request.log && scale.highest > 0.0;
  if (request.range) {
    scale.low = (*request.range)[0];
    scale.high = (*request.range)[1];
    scale.log = scale.log && scale.low > 0.0;
    if (request.map == ColorMap::Diverging && scale.low >= request.middle) scale.map = ColorMap::Warm;
    if (request.map == ColorMap::Diverging && scale.high <= request.middle) scale.map = ColorMap::Cool;
  } else if (scale.log) {
    std::vector<double> positive = finite;
    fit_log(positive, request.outliers, scale);
  } else {
    fit_linear(finite, request, scale);
  }
  count_beyond(finite, scale);
  return scale;
}

}  // namespace batten
