// Points and vectors, and functions of them under tf's names.
#ifndef TF_VECTOR3_H
#define TF_VECTOR3_H

#include "tf/LinearMath/MinMax.h"
#include "tf/LinearMath/Scalar.h"
#include "roscfe/linear_math/tags.h"
#include "roscfe/linear_math/vector3.h"

namespace tf
{

typedef roscfe::linear_math::Vector3<LinearMath> Vector3;
typedef roscfe::linear_math::Vector4<LinearMath> tfVector4;
typedef roscfe::linear_math::FourNumbers<float>  Vector3FloatData;
typedef roscfe::linear_math::FourNumbers<double> Vector3DoubleData;
typedef Vector3DoubleData                        Vector3Data;

inline tfScalar tfDot(const Vector3 &a, const Vector3 &b) { return a.dot(b); }
inline tfScalar tfDistance2(const Vector3 &a, const Vector3 &b) { return a.distance2(b); }
inline tfScalar tfDistance(const Vector3 &a, const Vector3 &b) { return a.distance(b); }
inline tfScalar tfAngle(const Vector3 &a, const Vector3 &b) { return a.angle(b); }
inline Vector3 tfCross(const Vector3 &a, const Vector3 &b) { return a.cross(b); }
inline tfScalar tfTriple(const Vector3 &a, const Vector3 &b, const Vector3 &c) { return a.triple(b, c); }
inline Vector3 lerp(const Vector3 &a, const Vector3 &b, const tfScalar &t) { return a.lerp(b, t); }

// Two vectors that span the plane orthogonal to `n`, which has length 1.
inline void tfPlaneSpace1(const Vector3 &n, Vector3 &p, Vector3 &q) { roscfe::linear_math::span_plane(n, p, q); }

inline void tfSwapScalarEndian(const tfScalar &from, tfScalar &to)
{
    to = roscfe::linear_math::swapped<tfScalar>(from);
}

inline void tfSwapVector3Endian(const Vector3 &from, Vector3 &to)
{
    for (int at = 0; at < 4; ++at)
        tfSwapScalarEndian(from[at], to[at]);
}

inline void tfUnSwapVector3Endian(Vector3 &vector)
{
    const Vector3 swapped = vector;
    tfSwapVector3Endian(swapped, vector);
}

} // namespace tf

#endif
