// Points and vectors, and functions of them under tf2's names.
#ifndef TF2_VECTOR3_H
#define TF2_VECTOR3_H

#include "tf2/LinearMath/MinMax.h"
#include "tf2/LinearMath/Scalar.h"
#include "roscfe/linear_math/tags.h"
#include "roscfe/linear_math/vector3.h"

namespace tf2
{

typedef roscfe::linear_math::Vector3<LinearMath> Vector3;
typedef roscfe::linear_math::Vector4<LinearMath> tf2Vector4;
typedef roscfe::linear_math::FourNumbers<float>  Vector3FloatData;
typedef roscfe::linear_math::FourNumbers<double> Vector3DoubleData;
typedef Vector3DoubleData                        Vector3Data;

inline tf2Scalar tf2Dot(const Vector3 &a, const Vector3 &b) { return a.dot(b); }
inline tf2Scalar tf2Distance2(const Vector3 &a, const Vector3 &b) { return a.distance2(b); }
inline tf2Scalar tf2Distance(const Vector3 &a, const Vector3 &b) { return a.distance(b); }
inline tf2Scalar tf2Angle(const Vector3 &a, const Vector3 &b) { return a.angle(b); }
inline Vector3 tf2Cross(const Vector3 &a, const Vector3 &b) { return a.cross(b); }
inline tf2Scalar tf2Triple(const Vector3 &a, const Vector3 &b, const Vector3 &c) { return a.triple(b, c); }
inline Vector3 lerp(const Vector3 &a, const Vector3 &b, const tf2Scalar &t) { return a.lerp(b, t); }

// Two vectors that span the plane orthogonal to `n`, which has length 1.
inline void tf2PlaneSpace1(const Vector3 &n, Vector3 &p, Vector3 &q) { roscfe::linear_math::span_plane(n, p, q); }

inline void tf2SwapScalarEndian(const tf2Scalar &from, tf2Scalar &to)
{
    to = roscfe::linear_math::swapped<tf2Scalar>(from);
}

inline void tf2SwapVector3Endian(const Vector3 &from, Vector3 &to)
{
    for (int at = 0; at < 4; ++at)
        tf2SwapScalarEndian(from[at], to[at]);
}

inline void tf2UnSwapVector3Endian(Vector3 &vector)
{
    const Vector3 swapped = vector;
    tf2SwapVector3Endian(swapped, vector);
}

} // namespace tf2

#endif
