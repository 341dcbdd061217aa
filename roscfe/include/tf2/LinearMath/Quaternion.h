// Rotations as quaternions, and functions of them in namespace tf2.
#ifndef TF2_QUATERNION_H_
#define TF2_QUATERNION_H_

#include "tf2/LinearMath/QuadWord.h"
#include "tf2/LinearMath/Vector3.h"
#include "roscfe/linear_math/quaternion.h"

namespace tf2
{

typedef roscfe::linear_math::Quaternion<LinearMath> Quaternion;

inline tf2Scalar dot(const Quaternion &a, const Quaternion &b) { return a.dot(b); }
inline tf2Scalar length(const Quaternion &q) { return q.length(); }
inline tf2Scalar angle(const Quaternion &a, const Quaternion &b) { return a.angle(b); }
inline tf2Scalar angleShortestPath(const Quaternion &a, const Quaternion &b) { return a.angleShortestPath(b); }
inline Quaternion inverse(const Quaternion &q) { return q.inverse(); }
inline Quaternion slerp(const Quaternion &a, const Quaternion &b, const tf2Scalar &t) { return a.slerp(b, t); }

inline Vector3 quatRotate(const Quaternion &rotation, const Vector3 &v)
{
    return roscfe::linear_math::turned(rotation, v);
}

inline Quaternion shortestArcQuat(const Vector3 &from, const Vector3 &to)
{
    return roscfe::linear_math::shortest_arc(from, to);
}

// As above, of vectors of any length; both get length 1.
inline Quaternion shortestArcQuatNormalize2(Vector3 &from, Vector3 &to)
{
    from.normalize();
    to.normalize();
    return shortestArcQuat(from, to);
}

} // namespace tf2

#endif
