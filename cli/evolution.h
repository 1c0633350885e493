/// \file How a surface came about: its rounds as files, as pictures and as a film, for verbs that go in rounds.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "batten/fit/surface_film.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

/// Where the rounds go.
struct EvolutionArguments {
  std::string folder;          ///< of control meshes, and of pictures with --picture; empty: none
  std::string film;            ///< a GLB; empty: none
  std::optional<int> moments;  ///< panels of the picture, instead of the result alone

  bool wanted() const { return !folder.empty() || !film.empty() || moments; }
};

/// Adds --frames, --film and --moments, which needs --picture.
void add_evolution(CLI::App& verb, EvolutionArguments& arguments);

/// Keeps the rounds while they are made and writes them.
class Evolution {
 public:
  /// Makes the folder, so that a name that cannot be one is known before any work. comment: what the meshes' files say,
  /// where their formats have comments. Throws Error(FileNotWritable).
  explicit Evolution(const EvolutionArguments& arguments, std::string comment = {});

  /// For FitOptions::watch and its like; empty where nothing is to be written. The evolution must outlive it.
  FrameWatcher watcher();
  /// So many rounds side by side, first and last among them.
  void draw_moments(const PictureArguments& picture, const Points& markers, double marker_radius, Job& job) const;
  /// Writes the control meshes as round-000.obj, ..., the pictures of them with `markers` where `picture` draws one,
  /// and the film; what the table says of it, empty without any.
  std::string write(const PictureArguments& picture, const Points& markers, double marker_radius, Job& job) const;

 private:
  Subject subject_of(Index frame, const Points& markers, double marker_radius, Mesh& mesh) const;
  void write_meshes(Job& job) const;
  void draw(const PictureArguments& picture, const Points& markers, double marker_radius, Job& job) const;
  void write_film(Job& job) const;

  const EvolutionArguments& arguments_;
  std::string comment_;
  SurfaceFilm film_;
};

}  // namespace batten::cli
