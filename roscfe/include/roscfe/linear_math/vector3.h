// Vector3 of tf and tf2: points and vectors. The operations and their order are tf2's, so results are equal to the bit.
#ifndef ROSCFE_LINEAR_MATH_VECTOR3_H
#define ROSCFE_LINEAR_MATH_VECTOR3_H

#include "roscfe/linear_math/quad_word.h"

namespace roscfe
{
namespace linear_math
{

template <class Tag>
class Vector3 : public QuadWord<Tag>
{
  public:
    using QuadWord<Tag>::m_floats;

    Vector3() = default;
    Vector3(const Scalar &x, const Scalar &y, const Scalar &z) : QuadWord<Tag>(x, y, z) {}

    void setValue(const Scalar &x, const Scalar &y, const Scalar &z) { QuadWord<Tag>::setValue(x, y, z); }

    // Arithmetic: with vectors by element, with numbers by scaling. The fourth number stays as it is.
    Vector3 &operator+=(const Vector3 &v) { return put(*this + v); }
    Vector3 &operator-=(const Vector3 &v) { return put(*this - v); }
    Vector3 &operator*=(const Vector3 &v) { return put(*this * v); }
    Vector3 &operator*=(const Scalar &s) { return put(*this * s); }
    Vector3 &operator/=(const Scalar &s) { return put(*this / s); }

    friend Vector3 operator+(const Vector3 &a, const Vector3 &b)
    {
        return Vector3(a.m_floats[0] + b.m_floats[0], a.m_floats[1] + b.m_floats[1], a.m_floats[2] + b.m_floats[2]);
    }
    friend Vector3 operator-(const Vector3 &a, const Vector3 &b)
    {
        return Vector3(a.m_floats[0] - b.m_floats[0], a.m_floats[1] - b.m_floats[1], a.m_floats[2] - b.m_floats[2]);
    }
    friend Vector3 operator*(const Vector3 &a, const Vector3 &b)
    {
        return Vector3(a.m_floats[0] * b.m_floats[0], a.m_floats[1] * b.m_floats[1], a.m_floats[2] * b.m_floats[2]);
    }
    friend Vector3 operator/(const Vector3 &a, const Vector3 &b)
    {
        return Vector3(a.m_floats[0] / b.m_floats[0], a.m_floats[1] / b.m_floats[1], a.m_floats[2] / b.m_floats[2]);
    }
    friend Vector3 operator-(const Vector3 &v) { return Vector3(-v.m_floats[0], -v.m_floats[1], -v.m_floats[2]); }
    friend Vector3 operator*(const Vector3 &v, const Scalar &s)
    {
        return Vector3(v.m_floats[0] * s, v.m_floats[1] * s, v.m_floats[2] * s);
    }
    friend Vector3 operator*(const Scalar &s, const Vector3 &v) { return v * s; }
    friend Vector3 operator/(const Vector3 &v, const Scalar &s) { return v * (1.0 / s); }

    Scalar dot(const Vector3 &v) const
    {
        return m_floats[0] * v.m_floats[0] + m_floats[1] * v.m_floats[1] + m_floats[2] * v.m_floats[2];
    }
    Vector3 cross(const Vector3 &v) const
    {
        return Vector3(m_floats[1] * v.m_floats[2] - m_floats[2] * v.m_floats[1],
                       m_floats[2] * v.m_floats[0] - m_floats[0] * v.m_floats[2],
                       m_floats[0] * v.m_floats[1] - m_floats[1] * v.m_floats[0]);
    }
    // The volume that this vector spans with two others.
    Scalar triple(const Vector3 &v1, const Vector3 &v2) const { return dot(v1.cross(v2)); }

    Scalar length2() const { return dot(*this); }
    Scalar length() const { return std::sqrt(length2()); }
    Scalar distance2(const Vector3 &v) const { return (v - *this).length2(); }
    Scalar distance(const Vector3 &v) const { return (v - *this).length(); }
    Scalar angle(const Vector3 &v) const { return arc_cosine(dot(v) / std::sqrt(length2() * v.length2())); }

    Vector3 &normalize() { return *this /= length(); }
    Vector3  normalized() const { return *this / length(); }

    // This vector turned about an axis of length 1, by an angle in rad.
    Vector3 rotate(const Vector3 &axis, const Scalar angle) const
    {
        const Vector3 along = axis * axis.dot(*this);
        return along + (*this - along) * std::cos(angle) + axis.cross(*this) * std::sin(angle);
    }

    Vector3 absolute() const { return Vector3(std::fabs(m_floats[0]), std::fabs(m_floats[1]), std::fabs(m_floats[2])); }

    // Index of the smallest and of the largest element, and of the axes furthest and closest in direction.
    int minAxis() const
    {
        if (m_floats[0] < m_floats[1])
            return m_floats[0] < m_floats[2] ? 0 : 2;
        return m_floats[1] < m_floats[2] ? 1 : 2;
    }
    int maxAxis() const
    {
        if (m_floats[0] < m_floats[1])
            return m_floats[1] < m_floats[2] ? 2 : 1;
        return m_floats[0] < m_floats[2] ? 2 : 0;
    }
    int furthestAxis() const { return absolute().minAxis(); }
    int closestAxis() const { return absolute().maxAxis(); }

    // Become the point between two: v0 for a ratio of 0, v1 for 1.
    void setInterpolate3(const Vector3 &v0, const Vector3 &v1, Scalar ratio)
    {
        const Scalar rest = 1.0 - ratio;
        for (int at = 0; at < 3; ++at)
            m_floats[at] = rest * v0.m_floats[at] + ratio * v1.m_floats[at];
    }
    Vector3 lerp(const Vector3 &v, const Scalar &t) const
    {
        return Vector3(m_floats[0] + (v.m_floats[0] - m_floats[0]) * t, m_floats[1] + (v.m_floats[1] - m_floats[1]) * t,
                       m_floats[2] + (v.m_floats[2] - m_floats[2]) * t);
    }

    // The rows of the matrix that makes the vector product with this vector.
    void getSkewSymmetricMatrix(Vector3 *v0, Vector3 *v1, Vector3 *v2) const
    {
        const Scalar x = m_floats[0], y = m_floats[1], z = m_floats[2];
        v0->setValue(0.0, -z, y);
        v1->setValue(z, 0.0, -x);
        v2->setValue(-y, x, 0.0);
    }

    void setZero() { setValue(0.0, 0.0, 0.0); }
    bool isZero() const { return m_floats[0] == 0.0 && m_floats[1] == 0.0 && m_floats[2] == 0.0; }
    bool fuzzyZero() const { return length2() < kEpsilon; }

    void serialize(FourNumbers<double> &to) const { this->save(to); }
    void serializeFloat(FourNumbers<float> &to) const { this->save(to); }
    void serializeDouble(FourNumbers<double> &to) const { this->save(to); }
    void deSerialize(const FourNumbers<double> &from) { this->load(from); }
    void deSerializeFloat(const FourNumbers<float> &from) { this->load(from); }
    void deSerializeDouble(const FourNumbers<double> &from) { this->load(from); }

  private:
    Vector3 &put(const Vector3 &v)
    {
        for (int at = 0; at < 3; ++at)
            m_floats[at] = v.m_floats[at];
        return *this;
    }
};

// A vector whose fourth number counts.
template <class Tag>
class Vector4 : public Vector3<Tag>
{
  public:
    using Vector3<Tag>::m_floats;

    Vector4() = default;
    Vector4(const Scalar &x, const Scalar &y, const Scalar &z, const Scalar &w) : Vector3<Tag>(x, y, z)
    {
        m_floats[3] = w;
    }

    void setValue(const Scalar &x, const Scalar &y, const Scalar &z, const Scalar &w)
    {
        QuadWord<Tag>::setValue(x, y, z, w);
    }

    Vector4 absolute4() const
    {
        return Vector4(std::fabs(m_floats[0]), std::fabs(m_floats[1]), std::fabs(m_floats[2]), std::fabs(m_floats[3]));
    }

    // Index of the largest and of the smallest element; -1 when none is within 1e30.
    int maxAxis4() const
    {
        int    found = -1;
        Scalar largest = -1e30;
        for (int at = 0; at < 4; ++at)
            if (m_floats[at] > largest)
                largest = m_floats[found = at];
        return found;
    }
    int minAxis4() const
    {
        int    found = -1;
        Scalar smallest = 1e30;
        for (int at = 0; at < 4; ++at)
            if (m_floats[at] < smallest)
                smallest = m_floats[found = at];
        return found;
    }
    int closestAxis4() const { return absolute4().maxAxis4(); }
};

// Two vectors that span the plane orthogonal to `n`, which has length 1.
template <class Tag>
void span_plane(const Vector3<Tag> &n, Vector3<Tag> &p, Vector3<Tag> &q)
{
    const Scalar x = n.x(), y = n.y(), z = n.z();
    if (std::fabs(z) > kSqrtOfHalf)
    {
        const Scalar a = y * y + z * z, k = 1.0 / std::sqrt(a);
        p.setValue(0.0, -z * k, y * k);
        q.setValue(a * k, -x * p.z(), x * p.y());
    }
    else
    {
        const Scalar a = x * x + y * y, k = 1.0 / std::sqrt(a);
        p.setValue(-y * k, x * k, 0.0);
        q.setValue(-z * p.y(), z * p.x(), a * k);
    }
}

} // namespace linear_math
} // namespace roscfe

#endif
