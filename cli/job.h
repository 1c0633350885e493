/// \file What verbs do alike, from the input to the report.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batten/parallel/threads.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/text.h"

namespace batten::cli {

/// A verb at work on one mesh.
struct Job {
  /// Limits the threads and reads the input; counts as a stage. The arguments must outlive it.
  Job(std::string verb_in, const CommonArguments& arguments);
  /// The same for a verb whose input is no mesh: `read` reads it, the mesh stays empty, and `usual_up` is up if the
  /// arguments do not say.
  Job(std::string verb_in, const CommonArguments& arguments, const std::function<void()>& read, UpAxis usual_up);

  /// The topology of the mesh; counts as a stage. Says on stderr where seams stay open. With --features the sharp edges
  /// that are found become creases of the mesh first, and are told by print() and report().
  Topology connect();
  /// The same, but the verb itself looks for the sharp edges.
  Topology connect_as_given();
  /// Writes a mesh to the output, if there is one, and tells what its format loses; counts as a stage.
  void write(const Mesh& result);
  /// Prints the table with the seconds of the stages as its last row.
  void print(Table table) const;
  /// Writes the report: verb, files and repairs, then these facts, then threads and seconds.
  void report(const nlohmann::ordered_json& facts = nlohmann::ordered_json::object()) const;

  std::string verb;
  const CommonArguments& common;
  ThreadLimit limit;
  Stages stages;
  nlohmann::ordered_json repairs;               ///< null without --repair
  std::vector<std::string> notes;               ///< what the readers skipped
  std::vector<std::string> lost;                ///< what the output lacks
  std::optional<Index> seam_vertices;           ///< coincident_boundary_count, known after connect()
  std::optional<std::vector<Crease>> features;  ///< the sharp edges that connect() found, where it looked for them
  Mesh mesh;
  UpAxis up;  ///< of the mesh as it was read
};

}  // namespace batten::cli
