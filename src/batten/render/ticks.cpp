#include "batten/render/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace batten::render_detail {
namespace {

constexpr const char* kMinus = "\u2212";

std::string with_true_minus(std::string text) {
  return !text.empty() && text[0] == '-' ? kMinus + text.substr(1) : text;
}

std::string fixed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return with_true_minus(buffer);
}

std::string superscript(int number) {
  static constexpr const char* kDigits[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                            "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = number < 0 ? "\u207B" : "";
  for (const char digit : std::to_string(std::abs(number))) text += kDigits[digit - '0'];
  return text;
}

std::string power_of_ten(int exponent) { return exponent == 0 ? "1" : "10" + superscript(exponent); }

/// The power of ten of a number's first digit after rounding to `digits`.
int exponent_of(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*e", digits - 1, value);
  return std::atoi(std::string(buffer).substr(std::string(buffer).find('e') + 1).c_str());
}

constexpr int kPlainBelow = 5;   // 10^5 and more are written as powers
constexpr int kPlainAbove = -4;  // 10^-4 and less too

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= 0.75 * rough) step = factor * power;
  }
  const int exponent = static_cast<int>(std::floor(std::log10(step) + 1e-9));
  const int top = exponent_of(std::max(std::abs(low), std::abs(high)), 3);
  const bool plain = top < kPlainBelow && exponent > kPlainAbove - 1;
  std::vector<Tick> ticks;
  const double slack = 1e-9 * (high - low);
  for (double i = std::ceil((low - slack) / step); i * step <= high + slack; ++i) {
    const double value = i * step;
    if (i == 0.0) {
      ticks.push_back({0.0, "0"});
    } else if (plain) {
      ticks.push_back({value, fixed(value, std::max(0, -exponent))});
    } else {
      const double scaled = value / std::pow(10.0, top);
      ticks.push_back({value, fixed(scaled, std::max(0, top - exponent)) + "\u00D7" + power_of_ten(top)});
    }
  }
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high, int wanted) {
  constexpr double kSlack = 1e-9;
  const int first = static_cast<int>(std::ceil(std::log10(low) - kSlack));
  const int last = static_cast<int>(std::floor(std::log10(high) + kSlack));
  std::vector<Tick> ticks;
  if (last - first < 1) {
    for (int exponent = first - 1; exponent <= last; ++exponent) {
      for (const int factor : {1, 2, 5}) {
        const double value = factor * std::pow(10.0, exponent);
        if (value >= low * (1.0 - kSlack) && value <= high * (1.0 + kSlack))
          ticks.push_back({value, number_text(value)});
      }
    }
    return ticks;
  }
  int stride = last - first + 1;
  for (const int candidate : {10, 5, 3, 2, 1}) {
    if ((last - first) / candidate <= wanted) stride = candidate;
  }
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % stride == 0) ticks.push_back({std::pow(10.0, exponent), power_of_ten(exponent)});
  }
  return ticks;
}

std::string number_text(double value, int digits) {
  if (value == 0.0) return "0";
  if (!std::isfinite(value)) return std::isnan(value) ? "NaN" : value > 0.0 ? "\u221E" : std::string(kMinus) + "\u221E";
  const int exponent = exponent_of(value, digits);
  const bool plain = exponent > kPlainAbove && exponent < kPlainBelow;
  const double shown = plain ? value : value / std::pow(10.0, exponent);
  const int decimals = plain ? std::max(0, digits - 1 - exponent) : digits - 1;
  std::string text = fixed(shown, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (plain) return text;
  if (text == "1") return power_of_ten(exponent);
  return text + "\u00D7" + power_of_ten(exponent);
}

}  // namespace batten::render_detail
