/// \file The one exception of the library.
#pragma once
#include <stdexcept>
#include <string>

namespace batten {

/// What went wrong, for a program; the message says it for a person, with the element and the way out.
enum class ErrorCode {
  BadArgument,        ///< an option or a parameter out of its range
  BadShape,           ///< a matrix whose rows or columns do not fit
  NotFinite,          ///< NaN or infinity
  IndexOutOfRange,    ///< a face, crease or corner names a vertex that does not exist
  DegenerateFace,     ///< fewer than three corners, or the same vertex twice in one face
  RepeatedFace,       ///< two faces with the same vertices in the same order
  NonManifoldEdge,    ///< more than two faces at an edge
  NonManifoldVertex,  ///< faces that meet only in a vertex
  InconsistentFaces,  ///< neighbours of opposite orientation; flipping some would do
  NonOrientable,      ///< no choice of orientations would do (a Moebius strip)
  NotTriangles,       ///< Loop on faces that are not triangles
  SingularSystem,     ///< no surface passes through arbitrary targets
  NotConverged,       ///< the iteration cap came before the tolerance
  FileNotReadable,
  FileNotWritable,
  BadFile,        ///< the text or the bytes are not what the format asks for
  UnknownFormat,  ///< a file name extension that no reader or writer knows
  TooLarge,       ///< more elements than a 32-bit index can count
  Cancelled,      ///< the progress callback asked to stop
  NotAvailable    ///< an optional part that this build lacks
};

/// A code for the program, a sentence for the person.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace batten
