#include "cli/verbs.h"

#include "cli/interpolate_from.h"
#include "cli/options.h"

namespace batten::cli {

namespace {

const Names<SolveMethod> kMethods{{"auto", SolveMethod::Auto},
                                  {"conjugate-gradient", SolveMethod::ConjugateGradient},
                                  {"chebyshev", SolveMethod::Chebyshev},
                                  {"jacobi", SolveMethod::Jacobi},
                                  {"richardson", SolveMethod::Richardson},
                                  {"direct", SolveMethod::Direct}};
const Names<OnSingular> kOnSingular{
    {"refuse", OnSingular::Refuse}, {"least-squares", OnSingular::LeastSquares}, {"alpha", OnSingular::Alpha}};
const Names<LimitMasks> kMasks{{"exact", LimitMasks::Exact}, {"opensubdiv", LimitMasks::OpenSubdiv}};
const Names<ShapeEnergyKind> kShapeEnergies{{"stretch", ShapeEnergyKind::Stretch},
                                            {"bending", ShapeEnergyKind::Bending},
                                            {"variation", ShapeEnergyKind::Variation}};
const Names<FaceKind> kFaces{{"quads", FaceKind::Quads}, {"triangles", FaceKind::Triangles}};

void add_adaptive(CLI::App& verb, SubdivideArguments& arguments) {
  add_length(verb, "--chord", arguments.chord,
             "as few faces as stay so near to the limit surface, in the mesh's unit or in % of the diagonal");
  add_length(verb, "--edge-length", arguments.edge_length, "as few faces as have no longer edge");
  verb.add_option("--angle", arguments.angle, "as few faces as turn by no more than so many degrees each")
      ->check(positive_number())
      ->option_text("DEGREES");
  add_choice(verb, "--faces", arguments.faces, kFaces,
             "with a bound: what to make; quads for Catmull-Clark and triangles for Loop, if not given");
  verb.add_option("--max-faces", arguments.max_faces, "with a bound: stop with an error beyond so many; 20 million")
      ->check(whole_number(1))
      ->option_text("N");
}

void add_fair(CLI::App& verb, FairArguments& fair) {
  verb.add_flag("--fair", fair.fair,
                "the surface through the points that swings least, on the mesh refined; its control mesh is written");
  verb.add_option("--fair-levels", fair.levels, "refine so often, 1 or 2; once if not given, with --normals twice")
      ->check(whole_number(1, 2));
  add_choice(verb, "--energy", fair.energy, kShapeEnergies,
             "what a fair surface has little of: area, curvature, or change of curvature (variation, if not given)");
  add_length(verb, "--smoothing", fair.smoothing, "let the surface leave the points: bumps shorter than this vanish");
}

void add_solver(CLI::App& verb, InterpolateOptions& options) {
  add_choice(verb, "--method", options.method, kMethods, "how to solve; jacobi is Thall's, richardson Lai and Cheng's");
  verb.add_option("--tolerance", options.tolerance, "largest miss, of the bounding box's diagonal")
      ->check(positive_number())
      ->capture_default_str();
  verb.add_option("--omega", options.omega, "damping of jacobi")->check(positive_number())->capture_default_str();
  verb.add_option("--max-iterations", options.max_iterations, "give up after so many")
      ->check(whole_number(1))
      ->capture_default_str();
  add_choice(verb, "--on-singular", options.on_singular, kOnSingular,
             "where no surface passes through such points; alpha if not given");
  add_choice(verb, "--limit-masks", options.masks, kMasks, "exact at darts and valence 2, or OpenSubdiv's masks there");
}

void add_normals(CLI::App& verb, NormalArguments& normals) {
  add_input_file(verb, "--normals", normals.source,
                 "refine twice and turn the surface's normals to the mesh's own, to estimates, or to those of a file")
      ->option_text("mesh|estimate|FILE");
  add_normal_tolerance(verb, normals.tolerance);
  verb.add_flag("!--keep-ripples", normals.relax,
                "turn normals and no more: in a fraction of the time and the memory, with stronger ripples");
}

void add_local(CLI::App& verb, InterpolateArguments& arguments) {
  add_input_file(verb, "--from", arguments.from,
                 "a control mesh of the same faces: move only what its surface needs to pass through INPUT's points")
      ->option_text("CONTROL");
  verb.add_option("--local", arguments.rings,
                  "with --from: move only control points so many rings around the points that it misses")
      ->check(whole_number(0, 1000))
      ->option_text("RINGS");
}

}  // namespace

void add_interpolate(CLI::App& app, InterpolateArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("interpolate", "the control mesh whose limit surface passes through the vertices");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_attributes(verb, arguments.common, "interpolated");
  add_picture(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  add_solver(verb, arguments.options);
  add_normals(verb, arguments.normals);
  verb.add_flag("--compare-methods", arguments.compare_methods,
                "solve by the papers' iterations and a direct solver too, and print (and plot) how they did");
  add_output_file(verb, "--plot", arguments.plot, "plot the residual against the iteration", {".png", ".svg"});
  verb.add_option("--levels", arguments.levels,
                  "write the limit surface refined so often, instead of the control mesh (.glb: always; 3 times "
                  "if not given, fewer for a large mesh)")
      ->check(whole_number(0, 12));
  add_fair(verb, arguments.fair);
  add_local(verb, arguments);
  set_run(verb, arguments.common, status, [&] {
    require_with(verb, {"--local"}, {"--from"});
    require_with(verb, {"--normal-tolerance", "--keep-ripples"}, {"--normals"});
    require_with(verb, {"--levels"}, {"--output"});
    require_with(verb, {"--fair-levels", "--energy", "--smoothing"}, {"--fair"});
    if (!arguments.from.empty()) {
      require_alone(verb, "--from",
                    {"--repair", "--triangulate", "--features", "--attributes", "--method", "--omega",
                     "--max-iterations", "--on-singular", "--compare-methods", "--plot", "--normals", "--fair"});
      require_output(verb);
      return run_interpolate_from(arguments);
    }
    require_output(verb, {"--compare-methods"});
    if (arguments.fair.fair) {
      require_alone(verb, "--fair",
                    {"--method", "--tolerance", "--omega", "--max-iterations", "--on-singular", "--limit-masks",
                     "--compare-methods", "--plot", "--normal-tolerance", "--keep-ripples"});
      if (arguments.picture.coloring == Coloring::Normals) require_alone(verb, "--fair", {"--color"});
      return run_fair(arguments);
    }
    if (arguments.options.method != SolveMethod::Jacobi) require_with(verb, {"--omega"}, {"--compare-methods"});
    return run_interpolate(arguments);
  });
}

void add_subdivide(CLI::App& app, SubdivideArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("subdivide", "refine a control mesh uniformly, or as far as a bound asks");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_attributes(verb, arguments.common, "scheme");
  verb.add_option("--levels", arguments.levels, "how often, once if not given; with a bound: at most so often")
      ->check(whole_number(0, 16));
  verb.add_flag("--limit", arguments.limit, "then move the vertices to the limit surface, with its normals");
  add_adaptive(verb, arguments);
  verb.add_flag(
      "--compare", arguments.compare,
      "measure how fair Butterfly, Modified Butterfly, the interpolated Loop and Catmull-Clark surfaces and "
      "the fairest Loop surface of a triangle mesh are; --picture draws them side by side by their mean curvature");
  add_picture(verb, arguments.picture);
  add_range(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb, {"--compare"});
    if (arguments.compare) {
      require_alone(verb, "--compare",
                    {"--output", "--scheme", "--tension", "--limit", "--chord", "--edge-length", "--angle", "--faces",
                     "--max-faces", "--attributes", "--face-varying"});
      return run_compare_schemes(arguments);
    }
    require_with(verb, {"--faces", "--max-faces"}, {"--chord", "--edge-length", "--angle"});
    if (!arguments.adaptive()) {
      if (arguments.levels > 12) throw UsageError("--levels: at most 12 without a bound");
      return run_subdivide(arguments);
    }
    require_alone(verb, "a bound", {"--limit"});
    return run_adaptive(arguments);
  });
}

void add_render(CLI::App& app, RenderArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("render", "draw a mesh's subdivision surface");
  add_input(verb, arguments.common);
  add_output_file(verb, "-o,--output", arguments.common.output, "picture to write", {".png"})->required();
  add_surface(verb, arguments.common);
  add_attributes(verb, arguments.common, "scheme");
  verb.add_option("--levels", arguments.levels, "refinement; as many as make it smooth, if not given")
      ->check(whole_number(0, 12));
  add_picture_options(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  add_input_file(verb, "--targets", arguments.targets,
                 "for --color error: the mesh whose vertices it should pass through");
  add_input_file(verb, "--values", arguments.values,
                 "colour by numbers that this mesh file has at its vertices, one a vertex of INPUT (PLY)");
  verb.add_option("--value", arguments.value, "for --values: the name of the numbers, where the file has several")
      ->option_text("NAME");
  verb.add_flag("--flat", arguments.flat, "draw the mesh as it is");
  verb.add_flag("--control", arguments.control, "with the control mesh as lines");
  verb.add_flag("--points", arguments.points, "with the vertices' limit positions");
  set_run(verb, arguments.common, status, [&] {
    if (arguments.picture.coloring != Coloring::Error && is_given(verb, "--targets"))
      throw UsageError("--targets does nothing without --color error");
    require_with(verb, {"--value"}, {"--values"});
    if (is_given(verb, "--values")) require_alone(verb, "--values", {"--color"});
    if (arguments.picture.coloring != Coloring::Checker && is_given(verb, "--face-varying"))
      throw UsageError("--face-varying does nothing without --color checker");
    if (arguments.flat) {
      require_alone(verb, "--flat",
                    {"--levels", "--scheme", "--boundary", "--creases", "--triangles", "--alpha", "--tension",
                     "--butterfly-boundary", "--features", "--attributes", "--face-varying"});
    }
    return run_render(arguments);
  });
}

void add_distance(CLI::App& app, DistanceArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("distance", "how far points lie from the limit surface of a mesh");
  add_input_file(verb, "SCAN", arguments.scan, "its vertices are measured: .obj .ply .off .stl .xyz")->required();
  add_input(verb, arguments.common, "SURFACE");
  add_output_file(verb, "-o,--output", arguments.common.output,
                  "write the scan with each point's distance, as the property \"distance\"", {".ply"});
  verb.add_flag("--ascii", arguments.common.ascii, "PLY as text");
  add_surface(verb, arguments.common);
  add_picture(verb, arguments.picture);
  add_range(verb, arguments.picture);
  set_run(verb, arguments.common, status, [&] {
    arguments.common.output_format = "ply";
    return run_distance(arguments);
  });
}

void add_info(CLI::App& app, InfoArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("info", "what a mesh is made of, and whether a surface can be made of it");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_repair_flag(verb, arguments.common);
  verb.add_flag("--curvature", arguments.curvature,
                "the surface's mean and Gaussian curvature at the vertices; -o writes the mesh with them");
  verb.add_flag("--self-intersections", arguments.self_intersections,
                "look for faces that pass through each other also in a mesh of more than 300,000 triangles");
  set_run(verb, arguments.common, status, [&] {
    require_with(verb, {"--output"}, {"--curvature"});
    return run_info(arguments);
  });
}

void add_repair(CLI::App& app, RepairArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("repair", "repair a mesh that has no surface, and list what was changed");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  CLI::Option* weld =
      verb.add_option("--weld", arguments.options.weld,
                      "weld open edges that lie so near, of the bounding box's diagonal; 0: equal points")
          ->check(number_in(0.0, 1.0))
          ->capture_default_str();
  verb.add_flag_callback(
          "--no-weld", [&] { arguments.options.weld = -1.0; }, "weld nothing")
      ->excludes(weld);
  set_run(verb, arguments.common, status, [&] {
    require_output(verb);
    return run_repair(arguments);
  });
}

}  // namespace batten::cli
