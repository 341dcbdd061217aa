// Four numbers, of which tf2::Quaternion is made.
#ifndef TF2SIMD_QUADWORD_H
#define TF2SIMD_QUADWORD_H

#include "tf2/LinearMath/MinMax.h"
#include "tf2/LinearMath/Scalar.h"
#include "roscfe/linear_math/quad_word.h"
#include "roscfe/linear_math/tags.h"

namespace tf2
{

typedef roscfe::linear_math::QuadWord<LinearMath> QuadWord;

} // namespace tf2

#endif
