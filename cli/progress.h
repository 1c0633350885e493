/// \file How long the stages of a run take: the progress bar while they last, their seconds afterwards.
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "batten/types.h"

namespace batten::cli {

/// Seconds a stage took, in order; JSON and the table's last line.
class Stages {
 public:
  /// Ends the running stage and gives it this name.
  void finish(const std::string& name);
  nlohmann::ordered_json json() const;
  std::string text() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<std::pair<std::string, double>> stages_;
};

/// Watches one stage: cancels it when a signal asked to stop (signals.h), and draws a bar on stderr where that is a
/// terminal and the tool has run for half a second. Every call that takes a progress callback gets one of these.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();
  /// Never empty; the bar must outlive it.
  Progress callback();

 private:
  void draw(double done);
  std::string label_;
  bool drawable_;
  bool drawn_ = false;
};

}  // namespace batten::cli
