// Matrix3x3 of tf and tf2: rotations as matrices. The operations and their order are tf2's.
#ifndef ROSCFE_LINEAR_MATH_MATRIX3X3_H
#define ROSCFE_LINEAR_MATH_MATRIX3X3_H

#include "roscfe/linear_math/quaternion.h"
#include "roscfe/linear_math/vector3.h"

namespace roscfe
{
namespace linear_math
{

// The rows of a matrix as plain numbers.
template <class Number>
struct NineNumbers
{
    FourNumbers<Number> m_el[3];
};

// Without arguments it is the identity; in ROS it is undefined.
template <class Tag>
class Matrix3x3
{
  public:
    Matrix3x3() { setIdentity(); }
    explicit Matrix3x3(const Quaternion<Tag> &q) { setRotation(q); }
    Matrix3x3(const Scalar &yaw, const Scalar &pitch, const Scalar &roll) { setEulerYPR(yaw, pitch, roll); }
    Matrix3x3(const Scalar &xx, const Scalar &xy, const Scalar &xz, const Scalar &yx, const Scalar &yy,
              const Scalar &yz, const Scalar &zx, const Scalar &zy, const Scalar &zz)
    {
        setValue(xx, xy, xz, yx, yy, yz, zx, zy, zz);
    }

    // -- parts ---------------------------------------------------------------------------------------------------

    Vector3<Tag>        getColumn(int i) const { return Vector3<Tag>(m_el[0][i], m_el[1][i], m_el[2][i]); }
    const Vector3<Tag> &getRow(int i) const { return m_el[i]; }
    Vector3<Tag> &      operator[](int i) { return m_el[i]; }
    const Vector3<Tag> &operator[](int i) const { return m_el[i]; }

    void setValue(const Scalar &xx, const Scalar &xy, const Scalar &xz, const Scalar &yx, const Scalar &yy,
                  const Scalar &yz, const Scalar &zx, const Scalar &zy, const Scalar &zz)
    {
        const Vector3<Tag> x(xx, xy, xz), y(yx, yy, yz), z(zx, zy, zz);
        m_el[0] = x;
        m_el[1] = y;
        m_el[2] = z;
    }
    void setIdentity() { setValue(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0); }

    static const Matrix3x3 &getIdentity()
    {
        static const Matrix3x3 identity;
        return identity;
    }

    // The upper left cells of a 4x4 matrix that is stored column by column.
    void setFromOpenGLSubMatrix(const Scalar *m)
    {
        setValue(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);
    }
    void getOpenGLSubMatrix(Scalar *m) const
    {
        for (int column = 0; column < 3; ++column)
        {
            for (int row = 0; row < 3; ++row)
                m[4 * column + row] = m_el[row][column];
            m[4 * column + 3] = 0.0;
        }
    }

    // -- rotations -----------------------------------------------------------------------------------------------

    // Become the rotation of a quaternion of any length.
    void setRotation(const Quaternion<Tag> &q)
    {
        const Scalar s = 2.0 / q.length2();
        const Scalar xs = q.x() * s, ys = q.y() * s, zs = q.z() * s;
        const Scalar wx = q.w() * xs, wy = q.w() * ys, wz = q.w() * zs;
        const Scalar xx = q.x() * xs, xy = q.x() * ys, xz = q.x() * zs;
        const Scalar yy = q.y() * ys, yz = q.y() * zs, zz = q.z() * zs;
        setValue(1.0 - (yy + zz), xy - wz, xz + wy, xy + wz, 1.0 - (xx + zz), yz - wx, xz - wy, yz + wx,
                 1.0 - (xx + yy));
    }

    // The quaternion of this rotation, with whichever sign keeps most digits.
    void getRotation(Quaternion<Tag> &q) const
    {
        const Scalar trace = m_el[0][0] + m_el[1][1] + m_el[2][2];
        Scalar       found[4];
        if (trace > 0.0)
        {
            const Scalar s = std::sqrt(trace + 1.0), part = 0.5 / s;
            found[0] = (m_el[2][1] - m_el[1][2]) * part;
            found[1] = (m_el[0][2] - m_el[2][0]) * part;
            found[2] = (m_el[1][0] - m_el[0][1]) * part;
            found[3] = s * 0.5;
        }
        else
        {
            const int    i = Vector3<Tag>(m_el[0][0], m_el[1][1], m_el[2][2]).maxAxis();
            const int    j = (i + 1) % 3, k = (i + 2) % 3;
            const Scalar s = std::sqrt(m_el[i][i] - m_el[j][j] - m_el[k][k] + 1.0), part = 0.5 / s;
            found[i] = s * 0.5;
            found[j] = (m_el[j][i] + m_el[i][j]) * part;
            found[k] = (m_el[k][i] + m_el[i][k]) * part;
            found[3] = (m_el[k][j] - m_el[j][k]) * part;
        }
        q.setValue(found[0], found[1], found[2], found[3]);
    }

    // Become a rotation by angles in rad about Z, then the new Y, then the new X.
    void setEulerYPR(Scalar z, Scalar y, Scalar x)
    {
        const Scalar ci = std::cos(x), cj = std::cos(y), ch = std::cos(z);
        const Scalar si = std::sin(x), sj = std::sin(y), sh = std::sin(z);
        const Scalar cc = ci * ch, cs = ci * sh, sc = si * ch, ss = si * sh;
        setValue(cj * ch, sj * sc - cs, sj * cc + ss, cj * sh, sj * ss + cc, sj * cs - sc, -sj, cj * si, cj * ci);
    }
    void setEulerZYX(const Scalar &yaw, const Scalar &pitch, const Scalar &roll) { setEulerYPR(yaw, pitch, roll); }
    void setRPY(Scalar roll, Scalar pitch, Scalar yaw) { setEulerYPR(yaw, pitch, roll); }

    // The angles of this rotation in rad; there are two solutions.
    void getEulerYPR(Scalar &yaw, Scalar &pitch, Scalar &roll, unsigned int solution_number = 1) const
    {
        const Scalar sine = m_el[2][0];
        if (std::fabs(sine) >= 1.0) // gimbal lock: only the sum or the difference of the other two angles counts
        {
            yaw = 0.0;
            pitch = sine < 0 ? kPi / 2.0 : -kPi / 2.0;
            roll = locked_roll(sine < 0);
            return;
        }
        pitch = -std::asin(sine);
        if (solution_number != 1)
            pitch = kPi - pitch;
        const Scalar c = std::cos(pitch);
        roll = std::atan2(m_el[2][1] / c, m_el[2][2] / c);
        yaw = std::atan2(m_el[1][0] / c, m_el[0][0] / c);
    }
    void getEulerZYX(Scalar &yaw, Scalar &pitch, Scalar &roll, unsigned int solution_number = 1) const
    {
        getEulerYPR(yaw, pitch, roll, solution_number);
    }
    void getRPY(Scalar &roll, Scalar &pitch, Scalar &yaw, unsigned int solution_number = 1) const
    {
        getEulerYPR(yaw, pitch, roll, solution_number);
    }

    // -- products ------------------------------------------------------------------------------------------------

    // Scalar products of a column and a vector.
    Scalar tdotx(const Vector3<Tag> &v) const { return column_dot(0, v); }
    Scalar tdoty(const Vector3<Tag> &v) const { return column_dot(1, v); }
    Scalar tdotz(const Vector3<Tag> &v) const { return column_dot(2, v); }

    friend Vector3<Tag> operator*(const Matrix3x3 &m, const Vector3<Tag> &v)
    {
        return Vector3<Tag>(m.m_el[0].dot(v), m.m_el[1].dot(v), m.m_el[2].dot(v));
    }
    friend Vector3<Tag> operator*(const Vector3<Tag> &v, const Matrix3x3 &m)
    {
        return Vector3<Tag>(m.tdotx(v), m.tdoty(v), m.tdotz(v));
    }
    friend Matrix3x3 operator*(const Matrix3x3 &a, const Matrix3x3 &b)
    {
        return of_rows(a.m_el[0] * b, a.m_el[1] * b, a.m_el[2] * b);
    }
    Matrix3x3 &operator*=(const Matrix3x3 &m) { return *this = *this * m; }

    // This matrix transposed, times another; and this times another transposed.
    Matrix3x3 transposeTimes(const Matrix3x3 &m) const { return transpose() * m; }
    Matrix3x3 timesTranspose(const Matrix3x3 &m) const { return of_rows(m * m_el[0], m * m_el[1], m * m_el[2]); }

    // The columns scaled by the elements of a vector.
    Matrix3x3 scaled(const Vector3<Tag> &s) const { return of_rows(m_el[0] * s, m_el[1] * s, m_el[2] * s); }

    // -- derived matrices ----------------------------------------------------------------------------------------

    Matrix3x3 transpose() const { return of_rows(getColumn(0), getColumn(1), getColumn(2)); }
    Matrix3x3 absolute() const { return of_rows(m_el[0].absolute(), m_el[1].absolute(), m_el[2].absolute()); }

    // The determinant of two rows and two columns.
    Scalar cofac(int r1, int c1, int r2, int c2) const
    {
        return m_el[r1][c1] * m_el[r2][c2] - m_el[r1][c2] * m_el[r2][c1];
    }
    Scalar determinant() const { return m_el[0].triple(m_el[1], m_el[2]); }

    // The inverse times the determinant.
    Matrix3x3 adjoint() const
    {
        return Matrix3x3(cofac(1, 1, 2, 2), cofac(0, 2, 2, 1), cofac(0, 1, 1, 2), cofac(1, 2, 2, 0),
                         cofac(0, 0, 2, 2), cofac(0, 2, 1, 0), cofac(1, 0, 2, 1), cofac(0, 1, 2, 0),
                         cofac(0, 0, 1, 1));
    }
    Matrix3x3 inverse() const
    {
        const Matrix3x3 found = adjoint();
        const Scalar    s = 1.0 / m_el[0].dot(found.getColumn(0));
        return of_rows(found.m_el[0] * s, found.m_el[1] * s, found.m_el[2] * s);
    }

    // Make this symmetric matrix diagonal, by Jacobi's method.
    //   rot: becomes the rotation R for which the old matrix is R * new * transposed R.
    //   threshold: how large elements off the diagonal may remain, in parts of the diagonal's sum.
    //   maxSteps: how often to turn.
    void diagonalize(Matrix3x3 &rot, Scalar threshold, int maxSteps)
    {
        rot.setIdentity();
        for (int step = maxSteps; step > 0; --step)
        {
            int p = 0, q = 1;
            if (std::fabs(m_el[0][2]) > std::fabs(m_el[p][q]))
                q = 2;
            if (std::fabs(m_el[1][2]) > std::fabs(m_el[p][q]))
                p = 1, q = 2;
            const Scalar size = std::fabs(m_el[p][q]);
            const Scalar small =
                threshold * (std::fabs(m_el[0][0]) + std::fabs(m_el[1][1]) + std::fabs(m_el[2][2]));
            if (size <= small)
            {
                if (size <= kEpsilon * small)
                    return;
                step = 1;
            }
            turn(rot, p, q);
        }
    }

    friend bool operator==(const Matrix3x3 &a, const Matrix3x3 &b)
    {
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                if (a.m_el[row][column] != b.m_el[row][column])
                    return false;
        return true;
    }

    template <class Number>
    void save(NineNumbers<Number> &to) const
    {
        for (int row = 0; row < 3; ++row)
            m_el[row].save(to.m_el[row]);
    }
    template <class Number>
    void load(const NineNumbers<Number> &from)
    {
        for (int row = 0; row < 3; ++row)
            m_el[row].load(from.m_el[row]);
    }
    void serialize(NineNumbers<double> &to) const { save(to); }
    void serializeFloat(NineNumbers<float> &to) const { save(to); }
    void deSerialize(const NineNumbers<double> &from) { load(from); }
    void deSerializeFloat(const NineNumbers<float> &from) { load(from); }
    void deSerializeDouble(const NineNumbers<double> &from) { load(from); }

  private:
    Vector3<Tag> m_el[3];

    static Matrix3x3 of_rows(const Vector3<Tag> &x, const Vector3<Tag> &y, const Vector3<Tag> &z)
    {
        return Matrix3x3(x.x(), x.y(), x.z(), y.x(), y.y(), y.z(), z.x(), z.y(), z.z());
    }

    Scalar column_dot(int i, const Vector3<Tag> &v) const
    {
        return m_el[0][i] * v.x() + m_el[1][i] * v.y() + m_el[2][i] * v.z();
    }

    // Roll in gimbal lock. tf reads it off the first row, tf2 off the last one.
    Scalar locked_roll(bool down) const
    {
        if (!Tag::kLockedRollFromFirstRow)
            return std::atan2(m_el[2][1], m_el[2][2]);
        return down ? std::atan2(m_el[0][1], m_el[0][2]) : std::atan2(-m_el[0][1], -m_el[0][2]);
    }

    // One rotation, which makes the element (p, q) vanish; `rot` is turned along.
    void turn(Matrix3x3 &rot, int p, int q)
    {
        const int    r = 3 - p - q;
        const Scalar element = m_el[p][q];
        const Scalar theta = (m_el[q][q] - m_el[p][p]) / (2 * element), theta2 = theta * theta;
        Scalar       tangent, cosine;
        if (theta2 * theta2 < 10 / kEpsilon)
        {
            const Scalar root = std::sqrt(1 + theta2);
            tangent = theta >= 0 ? 1 / (theta + root) : 1 / (theta - root);
            cosine = 1 / std::sqrt(1 + tangent * tangent);
        }
        else // almost diagonal: by a series
        {
            tangent = 1 / (theta * (2 + 0.5 / theta2));
            cosine = 1 - 0.5 * tangent * tangent;
        }
        const Scalar sine = cosine * tangent;
        m_el[p][q] = m_el[q][p] = 0;
        m_el[p][p] -= tangent * element;
        m_el[q][q] += tangent * element;
        const Scalar rp = m_el[r][p], rq = m_el[r][q];
        m_el[r][p] = m_el[p][r] = cosine * rp - sine * rq;
        m_el[r][q] = m_el[q][r] = cosine * rq + sine * rp;
        for (int i = 0; i < 3; ++i)
        {
            Vector3<Tag> &row = rot.m_el[i];
            const Scalar  a = row[p], b = row[q];
            row[p] = cosine * a - sine * b;
            row[q] = cosine * b + sine * a;
        }
    }
};

} // namespace linear_math
} // namespace roscfe

#endif
