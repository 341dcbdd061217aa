// The smaller and the larger of two values, as tf's LinearMath calls them.
#ifndef TF_MINMAX_H
#define TF_MINMAX_H

#include "roscfe/linear_math/min_max.h"

template <class T>
const T &tfMin(const T &a, const T &b)
{
    return a < b ? a : b;
}

template <class T>
const T &tfMax(const T &a, const T &b)
{
    return a > b ? a : b;
}

template <class T>
void tfSetMin(T &a, const T &b)
{
    roscfe::linear_math::set_min(a, b);
}

template <class T>
void tfSetMax(T &a, const T &b)
{
    roscfe::linear_math::set_max(a, b);
}

#endif
