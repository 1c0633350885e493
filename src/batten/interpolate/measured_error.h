/// \file How far a surface is from its targets, measured row by row in double.
///
/// Rows of the limit matrix sum to 1, so the error of vertex i is measured as P_i - Q_i + sum_j a_ij (P_j - P_i): what
/// is near keeps its digits wherever the origin is.
#pragma once
#include "batten/interpolate/free_block.h"
#include "batten/limit/limit_matrix.h"
#include "batten/solve/solver.h"

namespace batten {

struct MeasuredErrors {
  ErrorSummary errors;
  double movement = 0.0;  ///< max_i |P_i - Q_i|
};

/// control: a row for each vertex of the matrix's topology. targets: rows for the first of them, which are measured.
/// solved: where not empty, the errors of the free rows of `block`, measured already; those rows are left out.
MeasuredErrors measure_errors(const LimitMatrix& matrix, ConstValuesRef control, ConstValuesRef targets,
                              const FreeBlock& block, const ErrorSummary& solved);

/// The error of each target's row.
Buffer<double> row_errors(const LimitMatrix& matrix, ConstValuesRef control, ConstValuesRef targets);

}  // namespace batten
