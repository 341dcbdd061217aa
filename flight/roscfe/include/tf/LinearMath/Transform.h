// Rigid transforms: a rotation, then a translation.
#ifndef ROSCFE_TF_LINEARMATH_TRANSFORM_H
#define ROSCFE_TF_LINEARMATH_TRANSFORM_H

#include "tf/LinearMath/Matrix3x3.h"
#include "roscfe/linear_math/transform.h"

namespace tf
{

typedef roscfe::linear_math::Transform<LinearMath>      Transform;
typedef roscfe::linear_math::TransformNumbers<float>    TransformFloatData;
typedef roscfe::linear_math::TransformNumbers<double>   TransformDoubleData;
typedef TransformDoubleData                             TransformData;

} // namespace tf

#endif
