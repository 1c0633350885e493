/// \file Four doubles in one register.
#pragma once

namespace batten {

/// The compiler's vector type. It holds four columns of a row, or a point and one unused number.
using Double4 = double __attribute__((vector_size(32)));

}  // namespace batten
