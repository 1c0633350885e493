/// \file The frames of a simulation: kept, and written as files or as one animation.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/dynamics/elastic_run.h"
#include "cli/job.h"
#include "cli/simulate_arguments.h"

namespace batten::cli {

/// A moment of the run.
struct SimulationFrame {
  Index number;   ///< as in the name of its file
  double time;    ///< seconds
  Index refined;  ///< how often the mesh was refined by then
  Points points;  ///< of the control mesh
};

/// Collects frames; without an animation each is written at once.
class SimulationFrames {
 public:
  SimulationFrames(const SimulateArguments& arguments, const ElasticRun& run, Job& job);

  /// The frame of now, if its time has come and it is not there yet.
  void take_due();
  /// The state of now, if it is none of the frames, as one more.
  void take_last();
  /// Writes the animation, if that was asked for. What the table says was written. hurry: without progress, after a
  /// signal asked to stop.
  std::string finish(bool hurry);

  const std::vector<SimulationFrame>& frames() const { return frames_; }
  /// The control mesh of now in the shape of a frame.
  Mesh mesh_of(const SimulationFrame& frame) const;

 private:
  void take(Index number);
  void write_file(const SimulationFrame& frame);
  /// Of the surface to be written, where it is one: less by what the mesh was refined.
  std::optional<int> levels() const;

  const SimulateArguments& arguments_;
  const ElasticRun& run_;
  Job& job_;
  bool animated_;
  bool begins_anew_;  ///< frame 0 is this run's own
  std::vector<SimulationFrame> frames_;
  std::int64_t files_ = 0;
};

}  // namespace batten::cli
