#include "cli/expand.h"

#include "batten/error.h"
#include "cli/picture.h"
#include "cli/text.h"

namespace batten::cli {

void require_faces(const CommonArguments& common, const Mesh& mesh) {
  if (mesh.face_count() > 0) return;
  throw Error(
      ErrorCode::BadArgument,
      common.input + ": there are no faces, only points; smooth and rough are told by neighbours, which faces have");
}

const char* weights_word(SeriesMatrix matrix) { return matrix == SeriesMatrix::Limit ? "limit" : "cotangent"; }

std::string weights_text(const Scheme& scheme, SeriesMatrix matrix) {
  return scheme_text(scheme) + (matrix == SeriesMatrix::Limit ? "" : ", cotangent weights");
}

void draw_moved(const Mesh& before, const Mesh& after, const PictureArguments& picture, const std::string& caption,
                Job& job) {
  Subject subject;
  subject.control = &after;
  subject.flat = true;
  subject.before = &before;
  subject.before_caption = "the mesh given";
  subject.after_caption = caption;
  PictureArguments arguments = picture;
  if (picture.coloring == Coloring::Moved) {
    arguments.coloring = Coloring::None;
    subject.numbers = (after.points - before.points).rowwise().norm();
    subject.numbers_scale.title = "distance moved";
    subject.numbers_scale.unit = "in the mesh's unit";
  }
  draw(subject, arguments, job);
}

}  // namespace batten::cli
