// What interactive markers look like where the node does not say it (http://wiki.ros.org/interactive_markers).
#ifndef ROSCFE_INTERACTIVE_MARKERS_TOOLS_H
#define ROSCFE_INTERACTIVE_MARKERS_TOOLS_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "tf2/LinearMath/Matrix3x3.h"
#include "tf2/LinearMath/Quaternion.h"
#include "visualization_msgs/InteractiveMarker.h"

namespace interactive_markers
{
namespace detail
{

constexpr int kSteps = 36; // of a disc

inline void set_scale(visualization_msgs::Marker &marker, double x, double y, double z)
{
    marker.scale.x = x;
    marker.scale.y = y;
    marker.scale.z = z;
}

inline void set_white(visualization_msgs::Marker &marker)
{
    marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
}

inline std_msgs::ColorRGBA darker(const std_msgs::ColorRGBA &color, float by)
{
    std_msgs::ColorRGBA made;
    made.r = color.r * by;
    made.g = color.g * by;
    made.b = color.b * by;
    made.a = 1;
    return made;
}

// One that says nothing is upright.
inline void set_upright(geometry_msgs::Quaternion &orientation)
{
    if (orientation.w == 0 && orientation.x == 0 && orientation.y == 0 && orientation.z == 0)
    {
        orientation.w = 1;
    }
}

inline void normalize(geometry_msgs::Quaternion &orientation)
{
    set_upright(orientation);
    tf2::Quaternion made(orientation.x, orientation.y, orientation.z, orientation.w);
    made.normalize();
    orientation.x = made.x();
    orientation.y = made.y();
    orientation.z = made.z();
    orientation.w = made.w();
}

// A disc in the plane of y and z, of triangles between an inner circle and an outer one.
struct Disc
{
    visualization_msgs::Marker &marker;
    float                       width;

    geometry_msgs::Point at(int step, bool is_outer) const
    {
        const float          angle = static_cast<float>(static_cast<float>(step % kSteps) / kSteps * M_PI * 2.0);
        geometry_msgs::Point point;
        point.y = 0.5 * std::cos(angle);
        point.z = 0.5 * std::sin(angle);
        if (is_outer)
        {
            point.y = (1 + width) * point.y;
            point.z = (1 + width) * point.z;
        }
        return point;
    }
    geometry_msgs::Point inner(int step) const { return at(step, false); }
    geometry_msgs::Point outer(int step) const { return at(step, true); }

    void add(const geometry_msgs::Point &a, const geometry_msgs::Point &b, const geometry_msgs::Point &c)
    {
        marker.points.push_back(a);
        marker.points.push_back(b);
        marker.points.push_back(c);
    }
    void add_colors(const std_msgs::ColorRGBA &color)
    {
        marker.colors.push_back(color);
        marker.colors.push_back(color);
    }
};

} // namespace detail

// The color of an axis: that which it points along most, halfway transparent.
inline void assignDefaultColor(visualization_msgs::Marker &marker, const geometry_msgs::Quaternion &orientation)
{
    const tf2::Quaternion turn(orientation.x, orientation.y, orientation.z, orientation.w);
    const tf2::Vector3    axis = tf2::Matrix3x3(turn) * tf2::Vector3(1, 0, 0);
    const float           x    = static_cast<float>(std::fabs(axis.x()));
    const float           y    = static_cast<float>(std::fabs(axis.y()));
    const float           z    = static_cast<float>(std::fabs(axis.z()));
    const float           most = std::max(x, std::max(y, z));
    marker.color.r             = x / most;
    marker.color.g             = y / most;
    marker.color.b             = z / most;
    marker.color.a             = 0.5;
}

// An arrow along the control's axis, so far from the middle; a negative position is on the other side.
inline void makeArrow(const visualization_msgs::InteractiveMarker &msg,
                      visualization_msgs::InteractiveMarkerControl &control, float pos)
{
    control.markers.emplace_back();
    visualization_msgs::Marker &marker = control.markers.back();
    marker.pose.orientation            = control.orientation;
    marker.type                        = visualization_msgs::Marker::ARROW;
    detail::set_scale(marker, msg.scale * 0.15, msg.scale * 0.25, msg.scale * 0.2);
    assignDefaultColor(marker, control.orientation);
    const float side = pos > 0 ? 1 : -1;
    const float from = static_cast<float>(0.5 * std::fabs(pos));
    const float to   = static_cast<float>(from + 0.4);
    marker.points.resize(2);
    marker.points[0].x = side * msg.scale * from;
    marker.points[1].x = side * msg.scale * to;
}

// A disc around the control's axis; the width is relative to its inner radius.
inline void makeDisc(const visualization_msgs::InteractiveMarker &msg,
                     visualization_msgs::InteractiveMarkerControl &control, float width = 0.3)
{
    typedef visualization_msgs::InteractiveMarkerControl Control;
    control.markers.emplace_back();
    visualization_msgs::Marker &marker = control.markers.back();
    marker.pose.orientation            = control.orientation;
    marker.type                        = visualization_msgs::Marker::TRIANGLE_LIST;
    detail::set_scale(marker, msg.scale, msg.scale, msg.scale);
    assignDefaultColor(marker, control.orientation);
    const std_msgs::ColorRGBA color = marker.color;
    detail::Disc              disc{marker, width};
    const bool                moves = control.interaction_mode == Control::MOVE_ROTATE;
    for (int i = 0; i < detail::kSteps; i += moves ? 2 : 1)
    {
        if (control.interaction_mode == Control::ROTATE_AXIS) // teeth, by turns darker
        {
            disc.add(disc.inner(i), disc.outer(i + 1), disc.inner(i + 1));
            disc.add(disc.inner(i + 1), disc.outer(i + 1), disc.outer(i + 2));
            disc.add_colors(detail::darker(color, static_cast<float>(0.6 + 0.4 * (i % 2))));
        }
        else if (moves) // dark triangles outward, others inward
        {
            disc.add(disc.inner(i), disc.outer(i + 1), disc.inner(i + 1));
            disc.add(disc.inner(i + 1), disc.outer(i + 1), disc.inner(i + 2));
            disc.add_colors(detail::darker(color, 0.6f));
            disc.add(disc.outer(i), disc.outer(i + 1), disc.inner(i));
            disc.add(disc.outer(i + 1), disc.outer(i + 2), disc.inner(i + 2));
            disc.add_colors(color);
        }
        else
        {
            disc.add(disc.inner(i), disc.outer(i), disc.inner(i + 1));
            disc.add(disc.outer(i), disc.outer(i + 1), disc.inner(i + 1));
        }
    }
}

// A text above the marker, which faces the user.
inline void makeViewFacingButton(const visualization_msgs::InteractiveMarker &msg,
                                 visualization_msgs::InteractiveMarkerControl &control, std::string text)
{
    control.orientation_mode               = visualization_msgs::InteractiveMarkerControl::VIEW_FACING;
    control.independent_marker_orientation = false;
    control.markers.emplace_back();
    visualization_msgs::Marker &marker = control.markers.back();
    const float                 scale  = static_cast<float>(0.25 * msg.scale);
    const float                 height = static_cast<float>(1.2 * msg.scale);
    marker.type                        = visualization_msgs::Marker::TEXT_VIEW_FACING;
    detail::set_scale(marker, scale, scale, scale);
    detail::set_white(marker);
    marker.pose.position.x = scale * -0.1;
    marker.pose.position.z = height + scale * -0.1;
    marker.text            = text.c_str();
}

// Fill in what a control leaves out: its markers, their sizes, orientations and ids.
inline void autoComplete(const visualization_msgs::InteractiveMarker &msg,
                         visualization_msgs::InteractiveMarkerControl &control,
                         bool enable_autocomplete_transparency = true)
{
    typedef visualization_msgs::InteractiveMarkerControl Control;
    static std::int32_t                                  next_id = 0; // of this node
    detail::set_upright(control.orientation);
    if (control.markers.empty())
    {
        switch (control.interaction_mode)
        {
            case Control::MOVE_AXIS:
                makeArrow(msg, control, 1);
                makeArrow(msg, control, -1);
                break;
            case Control::MOVE_PLANE:
            case Control::ROTATE_AXIS:
            case Control::MOVE_ROTATE:
                makeDisc(msg, control);
                break;
            case Control::MENU:
                makeViewFacingButton(msg, control, control.description.c_str());
                break;
            default:
                break;
        }
    }
    for (visualization_msgs::Marker &marker : control.markers)
    {
        for (double *scale : {&marker.scale.x, &marker.scale.y, &marker.scale.z})
        {
            *scale = *scale == 0 ? 1 : *scale;
        }
        detail::normalize(marker.pose.orientation);
        marker.ns = msg.name;
        marker.id = next_id++;
        if (!enable_autocomplete_transparency && marker.color.a > 0)
        {
            marker.color.a = 1;
        }
    }
}

// A control whose name another one has gets a number behind it.
inline void uniqueifyControlNames(visualization_msgs::InteractiveMarker &msg)
{
    int                   number = 0;
    std::set<std::string> names;
    for (visualization_msgs::InteractiveMarkerControl &control : msg.controls)
    {
        std::string name = control.name.c_str();
        while (names.count(name) != 0)
        {
            name += "_u" + std::to_string(number++);
        }
        control.name = name.c_str();
        names.insert(name);
    }
}

// Fill in what a marker leaves out; one without controls takes another one away, and stays as it is.
inline void autoComplete(visualization_msgs::InteractiveMarker &msg, bool enable_autocomplete_transparency = true)
{
    if (msg.controls.empty())
    {
        return;
    }
    msg.scale = msg.scale == 0 ? 1 : msg.scale;
    detail::normalize(msg.pose.orientation);
    for (visualization_msgs::InteractiveMarkerControl &control : msg.controls)
    {
        autoComplete(msg, control, enable_autocomplete_transparency);
    }
    uniqueifyControlNames(msg);
}

// A control that shows the marker's description.
inline visualization_msgs::InteractiveMarkerControl makeTitle(const visualization_msgs::InteractiveMarker &msg)
{
    typedef visualization_msgs::InteractiveMarkerControl Control;
    Control                                              control;
    control.interaction_mode = Control::NONE;
    control.orientation_mode = Control::VIEW_FACING;
    control.always_visible   = true;
    control.markers.emplace_back();
    visualization_msgs::Marker &marker = control.markers.back();
    marker.type                        = visualization_msgs::Marker::TEXT_VIEW_FACING;
    detail::set_scale(marker, msg.scale * 0.15, msg.scale * 0.15, msg.scale * 0.15);
    detail::set_white(marker);
    marker.pose.position.z = msg.scale * 1.4;
    marker.text            = msg.description;
    autoComplete(msg, control);
    return control;
}

} // namespace interactive_markers

#endif
