/// \file What verbs do alike, from the input to the report.
#pragma once
#include "batten/parallel/threads.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/text.h"

namespace batten::cli {

/// A verb at work on one mesh.
struct Job {
  /// Limits the threads and reads the input; a stage. The arguments must outlive it.
  Job(std::string verb_in, const CommonArguments& arguments);

  /// Of the mesh; a stage.
  Topology connect();
  /// To the output, if there is one; a stage.
  void write(const Mesh& result);
  /// With the time as the last row.
  void print(Table table) const;
  /// Verb, files and repairs, then these facts, then threads and seconds.
  void report(const nlohmann::ordered_json& facts = nlohmann::ordered_json::object()) const;

  std::string verb;
  const CommonArguments& common;
  ThreadLimit limit;
  Stages stages;
  nlohmann::ordered_json repairs;  ///< null without --repair
  Mesh mesh;
};

}  // namespace batten::cli
