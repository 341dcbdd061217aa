// The smaller and the larger of two values, as tf2's LinearMath calls them.
#ifndef GEN_MINMAX_H
#define GEN_MINMAX_H

#include "roscfe/linear_math/min_max.h"

template <class T>
const T &tf2Min(const T &a, const T &b)
{
    return a < b ? a : b;
}

template <class T>
const T &tf2Max(const T &a, const T &b)
{
    return a > b ? a : b;
}

template <class T>
void tf2SetMin(T &a, const T &b)
{
    roscfe::linear_math::set_min(a, b);
}

template <class T>
void tf2SetMax(T &a, const T &b)
{
    roscfe::linear_math::set_max(a, b);
}

#endif
