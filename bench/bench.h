/// \file What the parts of the bench of record share. Ratios in one run count; single timings on a shared machine
/// don't.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "batten/interpolate/interpolator.h"

namespace batten::bench {

double median(std::vector<double> values);

/// Seconds of one call.
double seconds_of(const std::function<void()>& work);

/// Runs the works in turn, `rounds` times A B C A B C ..., after one warm-up each; the median seconds of each.
std::vector<double> in_turn(const std::vector<std::function<void()>>& works, int rounds);

/// A Markdown table, row by row.
class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<std::string>& header);
  void add(const std::vector<std::string>& row);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string number(double value, int digits = 3);

/// A mesh of the kind that people bring: beast.obj of the test data where BATTEN_DATA is set, else models/creature.obj,
/// refined until it has at least `vertices` vertices, its points moved by up to 0.3 mean edge lengths.
struct Subject {
  std::string name;
  Topology topology;
  Scheme scheme;
  Values targets;
};
Subject subject(Index vertices);
/// A noisy torus of about so many vertices.
Subject torus_subject(Index vertices);

/// The papers' iterations as whole sweeps over the mesh, with the tiles' kernel, order, precision and threads.
class Sweeps {
 public:
  explicit Sweeps(const Subject& subject);
  ~Sweeps();
  /// Thall's (Jacobi, omega 1/2) or Lai and Cheng's (Richardson) to the tolerance; returns the number of sweeps.
  int run(const Subject& subject, SolveMethod method, double tolerance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Eigen's conjugate gradients with a diagonal preconditioner, triplet assembly included; returns the largest miss.
double eigen_conjugate_gradients(const Subject& subject, double relative_tolerance);

/// The most memory that the process holds while the work runs, less what it held before, in bytes.
double peak_growth(const std::function<void()>& work);

/// The number after "key" in a small text file. Throws std::runtime_error where it isn't there.
double number_after(const std::string& path, const std::string& key);

/// Replaces what `./batten bench COMMAND` said before in the page of record, and leaves the other parts alone.
void write_part(const std::string& page, const std::string& command, const std::string& text);

/// The processor, the compiler and the copy bandwidth.
std::string machine();

std::string interpolation_section();
std::string growth_section();
std::string process_section();
std::string file_section();
std::string picture_section();
std::string nearest_section();
std::string series_section();

/// In a process of its own: interpolates a refined mesh of at least so many vertices, then exits.
int run_large(Index vertices);

}  // namespace batten::bench
