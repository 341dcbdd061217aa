// Four numbers, of which tf::Quaternion is made.
#ifndef TF_QUADWORD_H
#define TF_QUADWORD_H

#include "tf/LinearMath/MinMax.h"
#include "tf/LinearMath/Scalar.h"
#include "roscfe/linear_math/quad_word.h"
#include "roscfe/linear_math/tags.h"

namespace tf
{

typedef roscfe::linear_math::QuadWord<LinearMath> QuadWord;

} // namespace tf

#endif
