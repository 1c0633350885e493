/// \file The only exception that the library throws.
#pragma once
#include <stdexcept>
#include <string>

namespace batten {

/// What went wrong, as a code for programs. The message tells a person which element is wrong and what to do about it.
enum class ErrorCode {
  BadArgument,        ///< an option or a parameter out of its range
  BadShape,           ///< a matrix whose rows or columns do not fit
  NotFinite,          ///< NaN or infinity
  IndexOutOfRange,    ///< a face, crease or corner names a vertex that does not exist
  DegenerateFace,     ///< fewer than three corners, or the same vertex twice in one face
  RepeatedFace,       ///< two faces with the same vertices in the same order
  NonManifoldEdge,    ///< more than two faces at an edge
  NonManifoldVertex,  ///< faces that meet only in a vertex
  InconsistentFaces,  ///< neighbouring faces of opposite orientation; flipping some of them would repair it
  NonOrientable,      ///< no choice of orientations is consistent (a Moebius strip)
  NotTriangles,       ///< Loop or a Butterfly on faces that are not triangles
  SingularSystem,     ///< no surface passes through arbitrary targets
  NotConverged,       ///< the iterations reached their limit before the tolerance
  FileNotReadable,
  FileNotWritable,
  BadFile,        ///< the text or the bytes do not follow the format
  UnknownFormat,  ///< no reader or writer exists for the file name's extension
  TooLarge,       ///< more elements than a 32-bit index can count
  Cancelled,      ///< the progress callback asked to stop
  NotAvailable    ///< an optional part that this build lacks
};

/// An error code for the program and a sentence for the person.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace batten
