// Angles in rad and their distances on the circle (ROS's package angles).
#ifndef ROSCFE_ANGLES_ANGLES_H
#define ROSCFE_ANGLES_ANGLES_H

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace angles
{

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;

inline double from_degrees(double degrees) { return degrees * kPi / 180.0; }
inline double to_degrees(double radians) { return radians * 180.0 / kPi; }

// The same direction between 0 and 2 pi.
inline double normalize_angle_positive(double angle)
{
    const double rest = std::fmod(angle, kTwoPi);
    return rest < 0 ? rest + kTwoPi : rest;
}

// The same direction between -pi and pi.
inline double normalize_angle(double angle)
{
    const double rest = std::fmod(angle + kPi, kTwoPi);
    return rest <= 0.0 ? rest + kPi : rest - kPi;
}

// How far to turn, between -pi and pi.
inline double shortest_angular_distance(double from, double to) { return normalize_angle(to - from); }

// The same direction, turned to the other way round the circle.
inline double two_pi_complement(double angle)
{
    const double rest = angle > kTwoPi || angle < -kTwoPi ? std::fmod(angle, kTwoPi) : angle;
    if (rest < 0)
        return kTwoPi + rest;
    return rest > 0 ? rest - kTwoPi : kTwoPi;
}

// How far one may turn from an angle to both sides within limits of less than a circle.
// Returns whether the angle is within the limits; where it is not, the results are what is forbidden.
inline bool find_min_max_delta(double from, double left_limit, double right_limit, double &result_min_delta,
                               double &result_max_delta)
{
    const double left = shortest_angular_distance(from, left_limit);
    const double right = shortest_angular_distance(from, right_limit);
    const double left_other = two_pi_complement(left), right_other = two_pi_complement(right);
    if (left == 0)
    {
        result_min_delta = left;
        result_max_delta = std::max(right, right_other);
        return true;
    }
    if (right == 0)
    {
        result_max_delta = right;
        result_min_delta = std::min(left, left_other);
        return true;
    }
    const double least = std::min(left, left_other), least_other = std::max(left, left_other);
    const double most = std::max(right, right_other), most_other = std::min(right, right_other);
    if (least <= most_other || most >= least_other)
    {
        result_min_delta = most_other;
        result_max_delta = least_other;
        return left_limit == -kPi && right_limit == kPi;
    }
    result_min_delta = least;
    result_max_delta = most;
    return true;
}

// How far to turn so as to stay within limits, which may be more than a circle apart.
// Returns whether both ends are within the limits; if not, the result is the best way there is.
inline bool shortest_angular_distance_with_large_limits(double from, double to, double left_limit, double right_limit,
                                                        double &shortest_angle)
{
    double near = shortest_angular_distance(from, to), far = two_pi_complement(near);
    if (std::fabs(near) > std::fabs(far))
        std::swap(near, far);
    shortest_angle = near;
    if (left_limit > right_limit)
        return false;
    for (const double way : {near, far})
    {
        const double end = from + way;
        if (left_limit <= end && end <= right_limit)
        {
            shortest_angle = way;
            return left_limit <= from && from <= right_limit;
        }
    }
    return false;
}

// How far to turn so as to stay within limits of less than a circle.
// Returns whether both ends are within the limits; if not, the result leads towards them.
inline bool shortest_angular_distance_with_limits(double from, double to, double left_limit, double right_limit,
                                                  double &shortest_angle)
{
    double       least = -kTwoPi, most = kTwoPi, to_least = -kTwoPi, to_most = kTwoPi;
    const bool   from_is_within = find_min_max_delta(from, left_limit, right_limit, least, most);
    const double way = shortest_angular_distance(from, to), other = two_pi_complement(way);
    if (from_is_within)
    {
        for (const double each : {way, other})
        {
            if (each >= least && each <= most)
            {
                shortest_angle = each;
                return true;
            }
        }
        find_min_max_delta(to, left_limit, right_limit, to_least, to_most);
        least = to_most; // the target's limits decide, the other way round
        most = to_least;
    }
    if (std::fabs(least) < std::fabs(most))
        shortest_angle = std::min(way, other);
    else if (std::fabs(least) > std::fabs(most))
        shortest_angle = std::max(way, other);
    else
        shortest_angle = std::fabs(way) < std::fabs(other) ? way : other;
    return false;
}

} // namespace angles

#endif
