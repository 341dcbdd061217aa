// Quaternion of tf and tf2: rotations as quaternions. The operations and their order are tf2's.
#ifndef ROSCFE_LINEAR_MATH_QUATERNION_H
#define ROSCFE_LINEAR_MATH_QUATERNION_H

#include "roscfe/linear_math/quad_word.h"
#include "roscfe/linear_math/vector3.h"

namespace roscfe
{
namespace linear_math
{

// Without arguments it is the rotation that does not turn; in ROS it is undefined.
template <class Tag>
class Quaternion : public QuadWord<Tag>
{
  public:
    using QuadWord<Tag>::m_floats;
    using QuadWord<Tag>::setValue;
    using QuadWord<Tag>::x;
    using QuadWord<Tag>::y;
    using QuadWord<Tag>::z;
    using QuadWord<Tag>::w;

    Quaternion() : QuadWord<Tag>(0.0, 0.0, 0.0, 1.0) {}
    Quaternion(const Scalar &x_of, const Scalar &y_of, const Scalar &z_of, const Scalar &w_of)
        : QuadWord<Tag>(x_of, y_of, z_of, w_of)
    {
    }
    Quaternion(const Vector3<Tag> &axis, const Scalar &angle) { setRotation(axis, angle); }
    Quaternion(const Scalar &yaw, const Scalar &pitch, const Scalar &roll) { setEuler(yaw, pitch, roll); }

    // Become a rotation about an axis of any length, by an angle in rad.
    void setRotation(const Vector3<Tag> &axis, const Scalar &angle)
    {
        const Scalar s = std::sin(angle * 0.5) / axis.length();
        setValue(axis.x() * s, axis.y() * s, axis.z() * s, std::cos(angle * 0.5));
    }

    // Become a rotation by angles in rad about Y (yaw), X (pitch) and Z (roll).
    void setEuler(const Scalar &yaw, const Scalar &pitch, const Scalar &roll)
    {
        const Half h(yaw), p(pitch), r(roll);
        setValue(r.cos * p.sin * h.cos + r.sin * p.cos * h.sin, r.cos * p.cos * h.sin - r.sin * p.sin * h.cos,
                 r.sin * p.cos * h.cos - r.cos * p.sin * h.sin, r.cos * p.cos * h.cos + r.sin * p.sin * h.sin);
    }

    // Become a rotation by angles in rad about the fixed axes X, Y and Z.
    void setRPY(const Scalar &roll, const Scalar &pitch, const Scalar &yaw)
    {
        const Half h(yaw), p(pitch), r(roll);
        setValue(r.sin * p.cos * h.cos - r.cos * p.sin * h.sin, r.cos * p.sin * h.cos + r.sin * p.cos * h.sin,
                 r.cos * p.cos * h.sin - r.sin * p.sin * h.cos, r.cos * p.cos * h.cos + r.sin * p.sin * h.sin);
    }
    void setEulerZYX(const Scalar &yaw, const Scalar &pitch, const Scalar &roll) { setRPY(roll, pitch, yaw); }

    Quaternion &operator+=(const Quaternion &q) { return *this = *this + q; }
    Quaternion &operator-=(const Quaternion &q) { return *this = *this - q; }
    Quaternion &operator*=(const Quaternion &q) { return *this = *this * q; }
    Quaternion &operator*=(const Scalar &s) { return *this = *this * s; }
    Quaternion &operator/=(const Scalar &s) { return *this = *this / s; }

    friend Quaternion operator+(const Quaternion &a, const Quaternion &b)
    {
        return Quaternion(a.x() + b.x(), a.y() + b.y(), a.z() + b.z(), a.w() + b.w());
    }
    friend Quaternion operator-(const Quaternion &a, const Quaternion &b)
    {
        return Quaternion(a.x() - b.x(), a.y() - b.y(), a.z() - b.z(), a.w() - b.w());
    }
    friend Quaternion operator-(const Quaternion &q) { return Quaternion(-q.x(), -q.y(), -q.z(), -q.w()); }
    friend Quaternion operator*(const Quaternion &q, const Scalar &s)
    {
        return Quaternion(q.x() * s, q.y() * s, q.z() * s, q.w() * s);
    }
    friend Quaternion operator/(const Quaternion &q, const Scalar &s) { return q * (1.0 / s); }
    friend Quaternion operator*(const Quaternion &a, const Quaternion &b)
    {
        return Quaternion(a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
                          a.w() * b.y() + a.y() * b.w() + a.z() * b.x() - a.x() * b.z(),
                          a.w() * b.z() + a.z() * b.w() + a.x() * b.y() - a.y() * b.x(),
                          a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z());
    }
    // Products with a vector, which counts as a quaternion whose w is 0.
    friend Quaternion operator*(const Quaternion &q, const Vector3<Tag> &v)
    {
        return Quaternion(q.w() * v.x() + q.y() * v.z() - q.z() * v.y(), q.w() * v.y() + q.z() * v.x() - q.x() * v.z(),
                          q.w() * v.z() + q.x() * v.y() - q.y() * v.x(), -q.x() * v.x() - q.y() * v.y() - q.z() * v.z());
    }
    friend Quaternion operator*(const Vector3<Tag> &v, const Quaternion &q)
    {
        return Quaternion(v.x() * q.w() + v.y() * q.z() - v.z() * q.y(), v.y() * q.w() + v.z() * q.x() - v.x() * q.z(),
                          v.z() * q.w() + v.x() * q.y() - v.y() * q.x(), -v.x() * q.x() - v.y() * q.y() - v.z() * q.z());
    }

    Scalar dot(const Quaternion &q) const { return x() * q.x() + y() * q.y() + z() * q.z() + w() * q.w(); }
    Scalar length2() const { return dot(*this); }
    Scalar length() const { return std::sqrt(length2()); }

    Quaternion &normalize() { return *this /= length(); }
    Quaternion  normalized() const { return *this / length(); }
    Quaternion  inverse() const { return Quaternion(-x(), -y(), -z(), w()); }

    // Half the angle to another rotation, and the whole one along the shortest path, in rad.
    Scalar angle(const Quaternion &q) const { return arc_cosine(dot(q) / std::sqrt(length2() * q.length2())); }
    Scalar angleShortestPath(const Quaternion &q) const
    {
        return arc_cosine(std::fabs(dot(q)) / std::sqrt(length2() * q.length2())) * 2.0;
    }

    // The angle of the rotation, 0 to 2 pi rad, and along the shortest path, 0 to pi rad.
    Scalar getAngle() const { return 2.0 * arc_cosine(w()); }
    Scalar getAngleShortestPath() const { return 2.0 * arc_cosine(std::fabs(w())); }

    // The axis of the rotation; X when it hardly turns.
    Vector3<Tag> getAxis() const
    {
        const Scalar sine2 = 1.0 - w() * w();
        if (sine2 < 10.0 * kEpsilon)
            return Vector3<Tag>(1.0, 0.0, 0.0);
        const Scalar sine = std::sqrt(sine2);
        return Vector3<Tag>(x() / sine, y() / sine, z() / sine);
    }

    // That of q and -q, which mean the same rotation, that is farther away or nearer.
    Quaternion farthest(const Quaternion &q) const { return (*this - q).length2() > (*this + q).length2() ? q : -q; }
    Quaternion nearest(const Quaternion &q) const { return (*this - q).length2() < (*this + q).length2() ? q : -q; }

    // The rotation between this and another, at constant speed: this for `t` 0, the other for 1.
    Quaternion slerp(const Quaternion &q, const Scalar &t) const
    {
        const Scalar theta = angleShortestPath(q) / 2.0;
        if (theta == 0.0)
            return *this;
        const Scalar     d = 1.0 / std::sin(theta);
        const Scalar     s0 = std::sin((1.0 - t) * theta), s1 = std::sin(t * theta);
        const Quaternion to = dot(q) < 0 ? -q : q;
        return (*this * s0 + to * s1) * d;
    }

    static const Quaternion &getIdentity()
    {
        static const Quaternion identity(0.0, 0.0, 0.0, 1.0);
        return identity;
    }

  private:
    struct Half // cosine and sine of half of an angle
    {
        explicit Half(Scalar angle) : cos(std::cos(angle * 0.5)), sin(std::sin(angle * 0.5)) {}
        Scalar cos, sin;
    };
};

// A vector, turned.
template <class Tag>
Vector3<Tag> turned(const Quaternion<Tag> &rotation, const Vector3<Tag> &v)
{
    const Quaternion<Tag> q = rotation * v * rotation.inverse();
    return Vector3<Tag>(q.x(), q.y(), q.z());
}

// The rotation that turns one vector of length 1 to another.
template <class Tag>
Quaternion<Tag> shortest_arc(const Vector3<Tag> &from, const Vector3<Tag> &to)
{
    const Vector3<Tag> axis = from.cross(to);
    const Scalar       cosine = from.dot(to);
    if (cosine < -1.0 + kEpsilon) // any axis across does
    {
        Vector3<Tag> across, other;
        span_plane(from, across, other);
        return Quaternion<Tag>(across.x(), across.y(), across.z(), 0.0);
    }
    const Scalar s = std::sqrt((1.0 + cosine) * 2.0), part = 1.0 / s;
    return Quaternion<Tag>(axis.x() * part, axis.y() * part, axis.z() * part, s * 0.5);
}

} // namespace linear_math
} // namespace roscfe

#endif
