// Four numbers, what vectors and quaternions are stored in.
#ifndef ROSCFE_LINEAR_MATH_QUAD_WORD_H
#define ROSCFE_LINEAR_MATH_QUAD_WORD_H

#include "roscfe/linear_math/min_max.h"
#include "roscfe/linear_math/scalar.h"

namespace roscfe
{
namespace linear_math
{

// Four plain numbers, as the functions serialize of a Vector3 write them.
template <class Number>
struct FourNumbers
{
    Number m_floats[4];
};

// Without arguments it is all zero; in ROS it is undefined.
template <class Tag>
class QuadWord
{
  public:
    Scalar m_floats[4] = {0.0, 0.0, 0.0, 0.0};

    QuadWord() = default;
    QuadWord(const Scalar &x, const Scalar &y, const Scalar &z) : m_floats{x, y, z, 0.0} {}
    QuadWord(const Scalar &x, const Scalar &y, const Scalar &z, const Scalar &w) : m_floats{x, y, z, w} {}

    const Scalar &x() const { return m_floats[0]; }
    const Scalar &y() const { return m_floats[1]; }
    const Scalar &z() const { return m_floats[2]; }
    const Scalar &w() const { return m_floats[3]; }
    const Scalar &getX() const { return m_floats[0]; }
    const Scalar &getY() const { return m_floats[1]; }
    const Scalar &getZ() const { return m_floats[2]; }
    const Scalar &getW() const { return m_floats[3]; }

    void setX(Scalar x) { m_floats[0] = x; }
    void setY(Scalar y) { m_floats[1] = y; }
    void setZ(Scalar z) { m_floats[2] = z; }
    void setW(Scalar w) { m_floats[3] = w; }

    void setValue(const Scalar &x, const Scalar &y, const Scalar &z) { setValue(x, y, z, 0.0); }
    // By value: an argument may be one of the numbers that are set.
    void setValue(Scalar x, Scalar y, Scalar z, Scalar w)
    {
        m_floats[0] = x;
        m_floats[1] = y;
        m_floats[2] = z;
        m_floats[3] = w;
    }

    // Take each number of another one that is larger, or smaller.
    void setMax(const QuadWord &other)
    {
        for (int at = 0; at < 4; ++at)
            set_max(m_floats[at], other.m_floats[at]);
    }
    void setMin(const QuadWord &other)
    {
        for (int at = 0; at < 4; ++at)
            set_min(m_floats[at], other.m_floats[at]);
    }

    // Indexing works by these, as in ROS.
    operator Scalar *() { return m_floats; }
    operator const Scalar *() const { return m_floats; }

    bool operator==(const QuadWord &other) const
    {
        for (int at = 0; at < 4; ++at)
            if (m_floats[at] != other.m_floats[at])
                return false;
        return true;
    }
    bool operator!=(const QuadWord &other) const { return !(*this == other); }

    template <class Number>
    void save(FourNumbers<Number> &to) const
    {
        for (int at = 0; at < 4; ++at)
            to.m_floats[at] = static_cast<Number>(m_floats[at]);
    }
    template <class Number>
    void load(const FourNumbers<Number> &from)
    {
        for (int at = 0; at < 4; ++at)
            m_floats[at] = from.m_floats[at];
    }
};

} // namespace linear_math
} // namespace roscfe

#endif
