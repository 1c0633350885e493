/// \file Round numbers along an axis, and their text.
#pragma once
#include <string>
#include <vector>

namespace batten::render_detail {

struct Tick {
  double value;
  std::string text;  ///< empty for a tick without a label
};

/// Multiples of 1, 2 or 5 times a power of ten in [low, high], about `wanted` of them. low < high, both finite.
std::vector<Tick> linear_ticks(double low, double high, int wanted);

/// Powers of ten in [low, high] for positive low < high: every one, or every second, third, fifth and so on, so that
/// about `wanted` remain at most. If there are fewer than two, their multiples by 2 and 5 are added.
std::vector<Tick> log_ticks(double low, double high, int wanted);

/// `digits` significant digits with a minus sign (not a hyphen), in the form 3.2 x 10^-7 (with superscripts) if a plain
/// number would be long.
std::string number_text(double value, int digits = 3);

}  // namespace batten::render_detail
