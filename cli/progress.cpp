#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "cli/signals.h"

namespace batten::cli {

void Stages::finish(const std::string& name) {
  const auto now = std::chrono::steady_clock::now();
  stages_.emplace_back(name, std::chrono::duration<double>(now - start_).count());
  start_ = now;
}

nlohmann::ordered_json Stages::json() const {
  nlohmann::ordered_json json;
  for (const auto& stage : stages_) json[stage.first] = stage.second;
  return json;
}

std::string Stages::text() const {
  std::string text;
  double sum = 0.0;
  for (const auto& stage : stages_) {
    text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", stage.first, stage.second);
    sum += stage.second;
  }
  return fmt::format("{:.3f} s ({})", sum, text);
}

/// True ten times a second after the first half second, counted over the whole run: so short stages of a long run show
/// too.
static bool bar_is_due() {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point next = Clock::now() + std::chrono::milliseconds(500);
  const Clock::time_point now = Clock::now();
  if (now < next) return false;
  next = now + std::chrono::milliseconds(100);
  return true;
}

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), drawable_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

Progress ProgressBar::callback() {
  return [this](double done) {
    if (drawable_ && bar_is_due()) draw(done);
    return !stop_asked();
  };
}

void ProgressBar::draw(double done) {
  constexpr int kWidth = 30;
  const int filled = std::clamp(static_cast<int>(done * kWidth), 0, kWidth);
  fmt::print(stderr, "\r{} [{}{}] {:3.0f} %", label_, std::string(filled, '#'), std::string(kWidth - filled, '.'),
             100.0 * done);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace batten::cli
