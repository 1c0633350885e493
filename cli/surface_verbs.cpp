#include "cli/verbs.h"

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
const Names<FaceKind> kFaces{{"quads", FaceKind::Quads}, {"triangles", FaceKind::Triangles}};

void add_adaptive(CLI::App& verb, SubdivideArguments& arguments) {
  add_length(verb, "--chord", arguments.chord,
             "as few faces as stay so near to the limit surface, in the mesh's unit or in % of the diagonal");
  add_length(verb, "--edge-length", arguments.edge_length, "as few faces as have no longer edge");
  verb.add_option("--angle", arguments.angle, "as few faces as turn by no more than so many degrees each")
      ->check(CLI::PositiveNumber)
      ->option_text("DEGREES");
  add_choice(verb, "--faces", arguments.faces, kFaces,
             "with a bound: what to make; quads for Catmull-Clark and triangles for Loop, if not given");
  verb.add_option("--max-faces", arguments.max_faces, "with a bound: stop with an error beyond so many; 20 million")
      ->check(CLI::PositiveNumber)
      ->option_text("N");
}

}  // namespace

void add_interpolate(CLI::App& app, InterpolateArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("interpolate", "the control mesh whose limit surface passes through the vertices");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  add_picture(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  InterpolateOptions& options = arguments.options;
  add_choice(verb, "--method", options.method, kMethods, "how to solve; jacobi is Thall's, richardson Lai and Cheng's");
  verb.add_option("--tolerance", options.tolerance, "largest miss, of the bounding box's diagonal")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--omega", options.omega, "damping of jacobi")->check(CLI::PositiveNumber)->capture_default_str();
  verb.add_option("--max-iterations", options.max_iterations, "give up after so many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_choice(verb, "--on-singular", options.on_singular, kOnSingular,
             "where no surface passes through such points; alpha if not given");
  add_choice(verb, "--limit-masks", options.masks, kMasks, "exact at darts and valence 2, or OpenSubdiv's masks there");
  verb.add_flag("--compare-methods", arguments.compare_methods,
                "solve by the papers' iterations and a direct solver too, and print (and plot) how they did");
  verb.add_option("--plot", arguments.plot, "plot the residual against the iteration")
      ->check(has_extension({".png", ".svg"}))
      ->option_text("FILE.png|.svg");
  verb.add_option("--levels", arguments.levels,
                  "write the limit surface refined so often, instead of the control mesh (.glb: always; 3 times "
                  "if not given, fewer for a large mesh)")
      ->check(CLI::Range(0, 12));
  verb.callback([&] { status = run_interpolate(arguments); });
}

void add_subdivide(CLI::App& app, SubdivideArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("subdivide", "refine a control mesh uniformly, or as far as a bound asks");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  add_surface(verb, arguments.common);
  verb.add_option("--levels", arguments.levels, "how often, once if not given; with a bound: at most so often")
      ->check(CLI::Range(0, 16));
  verb.add_flag("--limit", arguments.limit, "then move the vertices to the limit surface, with its normals");
  add_adaptive(verb, arguments);
  verb.add_flag("--compare", arguments.compare,
                "measure how fair Butterfly, Modified Butterfly and the interpolated Loop and Catmull-Clark surfaces "
                "of a triangle mesh are; --picture draws them side by side by their mean curvature");
  add_picture(verb, arguments.picture);
  verb.callback([&verb, &arguments, &status] {
    if (arguments.compare) {
      require_alone(verb, "--compare",
                    {"--output", "--scheme", "--tension", "--limit", "--chord", "--edge-length", "--angle", "--faces",
                     "--max-faces"});
      status = run_compare_schemes(arguments);
      return;
    }
    if (!arguments.adaptive() && (arguments.faces || arguments.max_faces)) {
      throw CLI::ValidationError(arguments.faces ? "--faces" : "--max-faces",
                                 "needs a bound: --chord, --edge-length or --angle");
    }
    if (!arguments.adaptive() && arguments.levels > 12) {
      throw CLI::ValidationError("--levels", "at most 12 without a bound");
    }
    status = arguments.adaptive() ? run_adaptive(arguments) : run_subdivide(arguments);
  });
}

void add_render(CLI::App& app, RenderArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("render", "draw a mesh's subdivision surface");
  add_input(verb, arguments.common);
  verb.add_option("-o,--output", arguments.common.output, "picture to write")->required()->option_text("FILE.png");
  add_surface(verb, arguments.common);
  verb.add_option("--levels", arguments.levels, "refinement; as many as make it smooth, if not given")
      ->check(CLI::Range(0, 12));
  add_picture_options(verb, arguments.picture);
  add_coloring(verb, arguments.picture);
  verb.add_option("--targets", arguments.targets, "for --color error: the mesh whose vertices it should pass through")
      ->option_text("FILE");
  verb.add_flag("--flat", arguments.flat, "draw the mesh as it is");
  verb.add_flag("--control", arguments.control, "with the control mesh as lines");
  verb.add_flag("--points", arguments.points, "with the vertices' limit positions");
  verb.callback([&] { status = run_render(arguments); });
}

void add_distance(CLI::App& app, DistanceArguments& arguments, int& status) {
  CLI::App& verb = *app.add_subcommand("distance", "how far points lie from the limit surface of a mesh");
  verb.add_option("SCAN", arguments.scan, "its vertices are measured: .obj .ply .off .stl .xyz")->required();
  add_input(verb, arguments.common, "SURFACE");
  verb.add_option("-o,--output", arguments.common.output,
                  "write the scan with each point's distance, as the property \"distance\"")
      ->check(has_extension({".ply"}))
      ->option_text("FILE.ply");
  verb.add_flag("--ascii", arguments.common.ascii, "PLY as text");
  add_surface(verb, arguments.common);
  add_picture(verb, arguments.picture);
  verb.callback([&] { status = run_distance(arguments); });
}

void add_repair(CLI::App& app, RepairArguments& arguments, int& status) {
  CLI::App& verb =
      *app.add_subcommand("repair", "mend a mesh that no surface can be made of, and say what was changed");
  add_input(verb, arguments.common);
  add_output(verb, arguments.common);
  CLI::Option* weld =
      verb.add_option("--weld", arguments.options.weld,
                      "weld open edges that lie so near, of the bounding box's diagonal; 0: equal points")
          ->check(CLI::Range(0.0, 1.0))
          ->capture_default_str();
  verb.add_flag_callback(
          "--no-weld", [&] { arguments.options.weld = -1.0; }, "weld nothing")
      ->excludes(weld);
  verb.callback([&] { status = run_repair(arguments); });
}

}  // namespace batten::cli
