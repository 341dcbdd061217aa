// Rotations as matrices.
#ifndef TF2_MATRIX3x3_H
#define TF2_MATRIX3x3_H

#include "tf2/LinearMath/Quaternion.h"
#include "tf2/LinearMath/Vector3.h"
#include "roscfe/linear_math/matrix3x3.h"

namespace tf2
{

typedef roscfe::linear_math::Matrix3x3<LinearMath> Matrix3x3;
typedef roscfe::linear_math::NineNumbers<float>    Matrix3x3FloatData;
typedef roscfe::linear_math::NineNumbers<double>   Matrix3x3DoubleData;
typedef Matrix3x3DoubleData                        Matrix3x3Data;

inline Matrix3x3 tf2MultTransposeLeft(const Matrix3x3 &a, const Matrix3x3 &b) { return a.transposeTimes(b); }

} // namespace tf2

#endif
