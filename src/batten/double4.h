/// \file Four doubles in one register.
#pragma once

namespace batten {

/// The compiler's vector type: four columns of a row, or a point and a number to spare.
using Double4 = double __attribute__((vector_size(32)));

}  // namespace batten
