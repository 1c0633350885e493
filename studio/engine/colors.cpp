#include "studio/engine/colors.h"

#include <cmath>
#include <vector>

#include "batten/render/srgb.h"
#include "batten/render/ticks.h"

namespace batten::studio {
namespace {

constexpr int kBarColors = 256;
constexpr int kTicks = 6;

std::vector<unsigned char> bar_colors(ColorMap map) {
  std::vector<unsigned char> bytes;
  for (int i = 0; i < kBarColors; ++i)
    for (const float part : map_color(map, i / (kBarColors - 1.0)))
      bytes.push_back(static_cast<unsigned char>(std::lround(255.0F * render_detail::encode_srgb(part))));
  return bytes;
}

val scale_object(const ColorScale& scale) {
  val result = val::object();
  result.set("title", scale.title);
  result.set("unit", scale.unit);
  for (const auto& [name, number] : {std::pair{"low", scale.low}, std::pair{"high", scale.high},
                                     std::pair{"lowest", scale.lowest}, std::pair{"highest", scale.highest}})
    result.set(name, number);
  result.set("lowestText", render_detail::number_text(scale.lowest));
  result.set("highestText", render_detail::number_text(scale.highest));
  result.set("colors", typed_array(bar_colors(scale.map)));
  std::vector<render_detail::Tick> ticks;
  if (scale.low < scale.high) {
    ticks = scale.log ? render_detail::log_ticks(scale.low, scale.high, kTicks)
                      : render_detail::linear_ticks(scale.low, scale.high, kTicks);
  }
  result.set("ticks", list(ticks, [&](const render_detail::Tick& tick) {
               val one = val::object();
               one.set("place", scale.position(tick.value));
               one.set("text", tick.text);
               return one;
             }));
  return result;
}

}  // namespace

val colored(const Scalars& numbers, const ScaleRequest& request) {
  const ColorScale scale = fit_color_scale(numbers, request);
  std::vector<float> positions;
  positions.reserve(static_cast<std::size_t>(numbers.size()));
  for (const double number : numbers) {
    const double position = scale.position(number);
    positions.push_back(std::isnan(position) ? -1.0F : static_cast<float>(position));
  }
  val result = val::object();
  result.set("numbers", typed_array(numbers));
  result.set("positions", typed_array(positions));
  result.set("scale", scale_object(scale));
  return result;
}

}  // namespace batten::studio
