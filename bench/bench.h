/// \file Functions that the parts of the bench of record share. Only ratios within one run are meaningful on a shared
/// machine; single timings are not.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "batten/interpolate/interpolator.h"

namespace batten::bench {

double median(std::vector<double> values);

/// The seconds of one call.
double seconds_of(const std::function<void()>& work);

/// Runs the works alternately, `rounds` times A B C A B C ..., after a warm-up of each. Returns the median seconds of
/// each.
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

/// A typical mesh: beast.obj of the test data if BATTEN_DATA is set, otherwise models/creature.obj. It is refined until
/// it has at least `vertices` vertices, and its points are moved by up to 0.3 mean edge lengths.
struct Subject {
  std::string name;
  Topology topology;
  Scheme scheme;
  Values targets;
};
Subject subject(Index vertices);
/// A noisy torus of about this many vertices.
Subject torus_subject(Index vertices);

/// The papers' iterations as whole sweeps over the mesh, with the kernel, order, precision and threads of the tiles.
class Sweeps {
 public:
  explicit Sweeps(const Subject& subject);
  ~Sweeps();
  /// Runs Thall's method (Jacobi, omega 1/2) or Lai and Cheng's (Richardson) to the tolerance. Returns the number of
  /// sweeps.
  int run(const Subject& subject, SolveMethod method, double tolerance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Eigen's conjugate gradients with a diagonal preconditioner, including the assembly from triplets. Returns the
/// largest distance from a target.
double eigen_conjugate_gradients(const Subject& subject, double relative_tolerance);

/// The growth of the process's peak memory during the work, in bytes.
double peak_growth(const std::function<void()>& work);

/// The number after "key" in a small text file. Throws std::runtime_error if it is missing.
double number_after(const std::string& path, const std::string& key);

/// Replaces the output of `./batten bench COMMAND` in the page of record and keeps the other parts.
void write_part(const std::string& page, const std::string& command, const std::string& text);

/// The processor, the compiler and the copy bandwidth.
std::string machine();

std::string interpolation_section();
std::string growth_section();
std::string update_section();
std::string process_section();
std::string file_section();
std::string picture_section();
std::string nearest_section();
std::string series_section();
std::string dynamics_section();

/// For a separate process: interpolates a refined mesh of at least this many vertices and exits.
int run_large(Index vertices);

}  // namespace batten::bench
