// Transform of tf and tf2: a rotation, then a translation. The operations and their order are tf2's.
#ifndef ROSCFE_LINEAR_MATH_TRANSFORM_H
#define ROSCFE_LINEAR_MATH_TRANSFORM_H

#include "roscfe/linear_math/matrix3x3.h"

namespace roscfe
{
namespace linear_math
{

template <class Number>
struct TransformNumbers
{
    NineNumbers<Number> m_basis;
    FourNumbers<Number> m_origin;
};

// Without arguments it is the identity; in ROS it is undefined.
template <class Tag>
class Transform
{
  public:
    Transform() = default;
    explicit Transform(const Quaternion<Tag> &rotation, const Vector3<Tag> &origin = Vector3<Tag>(0.0, 0.0, 0.0))
        : m_basis(rotation), m_origin(origin)
    {
    }
    explicit Transform(const Matrix3x3<Tag> &basis, const Vector3<Tag> &origin = Vector3<Tag>(0.0, 0.0, 0.0))
        : m_basis(basis), m_origin(origin)
    {
    }

    Matrix3x3<Tag> &      getBasis() { return m_basis; }
    const Matrix3x3<Tag> &getBasis() const { return m_basis; }
    Vector3<Tag> &        getOrigin() { return m_origin; }
    const Vector3<Tag> &  getOrigin() const { return m_origin; }
    Quaternion<Tag>       getRotation() const
    {
        Quaternion<Tag> q;
        m_basis.getRotation(q);
        return q;
    }

    void setBasis(const Matrix3x3<Tag> &basis) { m_basis = basis; }
    void setRotation(const Quaternion<Tag> &q) { m_basis.setRotation(q); }
    void setOrigin(const Vector3<Tag> &origin) { m_origin = origin; }
    void setIdentity()
    {
        m_basis.setIdentity();
        m_origin.setZero();
    }
    static const Transform &getIdentity()
    {
        static const Transform identity;
        return identity;
    }

    // A 4x4 matrix that is stored column by column.
    void setFromOpenGLMatrix(const Scalar *m)
    {
        m_basis.setFromOpenGLSubMatrix(m);
        m_origin.setValue(m[12], m[13], m[14]);
    }
    void getOpenGLMatrix(Scalar *m) const
    {
        m_basis.getOpenGLSubMatrix(m);
        m[12] = m_origin.x();
        m[13] = m_origin.y();
        m[14] = m_origin.z();
        m[15] = 1.0;
    }

    // A point, transformed.
    Vector3<Tag> operator()(const Vector3<Tag> &x) const
    {
        return Vector3<Tag>(m_basis[0].dot(x) + m_origin.x(), m_basis[1].dot(x) + m_origin.y(),
                            m_basis[2].dot(x) + m_origin.z());
    }
    Vector3<Tag>    operator*(const Vector3<Tag> &x) const { return (*this)(x); }
    Quaternion<Tag> operator*(const Quaternion<Tag> &q) const { return getRotation() * q; }
    Transform       operator*(const Transform &t) const { return Transform(m_basis * t.m_basis, (*this)(t.m_origin)); }
    Transform &     operator*=(const Transform &t)
    {
        m_origin += m_basis * t.m_origin;
        m_basis *= t.m_basis;
        return *this;
    }
    void mult(const Transform &t1, const Transform &t2) { *this = t1 * t2; }

    // The transform back; the same, times another; and a point transformed back.
    Transform inverse() const
    {
        const Matrix3x3<Tag> back = m_basis.transpose();
        return Transform(back, back * -m_origin);
    }
    Transform inverseTimes(const Transform &t) const
    {
        return Transform(m_basis.transposeTimes(t.m_basis), (t.m_origin - m_origin) * m_basis);
    }
    Vector3<Tag> invXform(const Vector3<Tag> &v) const { return m_basis.transpose() * (v - m_origin); }

    friend bool operator==(const Transform &a, const Transform &b)
    {
        return a.m_basis == b.m_basis && a.m_origin == b.m_origin;
    }

    template <class Number>
    void save(TransformNumbers<Number> &to) const
    {
        m_basis.save(to.m_basis);
        m_origin.save(to.m_origin);
    }
    template <class Number>
    void load(const TransformNumbers<Number> &from)
    {
        m_basis.load(from.m_basis);
        m_origin.load(from.m_origin);
    }
    void serialize(TransformNumbers<double> &to) const { save(to); }
    void serializeFloat(TransformNumbers<float> &to) const { save(to); }
    void deSerialize(const TransformNumbers<double> &from) { load(from); }
    void deSerializeFloat(const TransformNumbers<float> &from) { load(from); }
    void deSerializeDouble(const TransformNumbers<double> &from) { load(from); }

  private:
    Matrix3x3<Tag> m_basis;
    Vector3<Tag>   m_origin;
};

} // namespace linear_math
} // namespace roscfe

#endif
