// Rigid transforms: a rotation, then a translation.
#ifndef tf2_Transform_H
#define tf2_Transform_H

#include "tf2/LinearMath/Matrix3x3.h"
#include "roscfe/linear_math/transform.h"

namespace tf2
{

typedef roscfe::linear_math::Transform<LinearMath>      Transform;
typedef roscfe::linear_math::TransformNumbers<float>    TransformFloatData;
typedef roscfe::linear_math::TransformNumbers<double>   TransformDoubleData;
typedef TransformDoubleData                             TransformData;

} // namespace tf2

#endif
