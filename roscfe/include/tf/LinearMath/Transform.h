// Rigid transforms: a rotation, then a translation.
#ifndef tfTransform_H
#define tfTransform_H

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
