// laser_geometry::LaserProjection: scans of a laser as clouds of points (http://wiki.ros.org/laser_geometry).
#ifndef ROSCFE_LASER_GEOMETRY_LASER_GEOMETRY_H
#define ROSCFE_LASER_GEOMETRY_LASER_GEOMETRY_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sensor_msgs/LaserScan.h"
#include "sensor_msgs/PointCloud.h"
#include "sensor_msgs/PointCloud2.h"
#include "sensor_msgs/point_field_conversion.h"
#include "tf/tf.h"
#include "tf2/LinearMath/Transform.h"
#include "tf2/buffer_core.h"

namespace laser_geometry
{

const float LASER_SCAN_INVALID   = -1.0;
const float LASER_SCAN_MIN_RANGE = -2.0;
const float LASER_SCAN_MAX_RANGE = -3.0;

namespace channel_option
{

// What is said of each point beside its place.
enum ChannelOption
{
    None      = 0x00,
    Intensity = 0x01,
    Index     = 0x02, // in the scan
    Distance  = 0x04,
    Timestamp = 0x08, // in seconds from the first ray
    Viewpoint = 0x10, // where the laser was
    Default   = Intensity | Index
};

} // namespace channel_option

// Ranges outside of the scan's bounds are left out, and those that are not below the cutoff in meters; a negative one is
// the scan's greatest range.
class LaserProjection
{
  public:
    void projectLaser(const sensor_msgs::LaserScan &scan_in, sensor_msgs::PointCloud &cloud_out,
                      double range_cutoff = -1.0, int channel_options = channel_option::Default)
    {
        keep(scan_in, range_cutoff);
        cloud_out.header = scan_in.header;
        cloud_out.points.resize(kept_.size());
        for (std::size_t i = 0; i < kept_.size(); ++i)
        {
            const double range    = scan_in.ranges[kept_[i]];
            cloud_out.points[i].x = static_cast<float>(range * rays_[kept_[i]].x);
            cloud_out.points[i].y = static_cast<float>(range * rays_[kept_[i]].y);
            cloud_out.points[i].z = 0;
        }
        cloud_out.channels.resize(0);
        for (const int option : {channel_option::Intensity, channel_option::Index, channel_option::Distance,
                                 channel_option::Timestamp})
        {
            if (!has(scan_in, channel_options, option))
            {
                continue;
            }
            cloud_out.channels.emplace_back();
            cloud_out.channels.back().name = option == channel_option::Intensity ? "intensities" : name_of(option);
            cloud_out.channels.back().values.resize(kept_.size());
            for (std::size_t i = 0; i < kept_.size(); ++i)
            {
                cloud_out.channels.back().values[i] = value_of(scan_in, option, kept_[i]);
            }
        }
    }

    void projectLaser(const sensor_msgs::LaserScan &scan_in, sensor_msgs::PointCloud2 &cloud_out,
                      double range_cutoff = -1.0, int channel_options = channel_option::Default)
    {
        keep(scan_in, range_cutoff);
        cloud_out.header = scan_in.header;
        cloud_out.height = 1;
        cloud_out.width  = static_cast<std::uint32_t>(kept_.size());
        cloud_out.fields.resize(0);
        cloud_out.point_step = 0;
        for (const char *axis : {"x", "y", "z"})
        {
            add_field(cloud_out, axis);
        }
        for (const int option : {channel_option::Intensity, channel_option::Index, channel_option::Distance,
                                 channel_option::Timestamp})
        {
            if (has(scan_in, channel_options, option))
            {
                const bool is_index = option == channel_option::Index;
                add_field(cloud_out, name_of(option), is_index ? Field::INT32 : Field::FLOAT32);
            }
        }
        if (has(scan_in, channel_options, channel_option::Viewpoint))
        {
            for (const char *axis : {"vp_x", "vp_y", "vp_z"})
            {
                add_field(cloud_out, axis);
            }
        }
        cloud_out.row_step = cloud_out.point_step * cloud_out.width;
        cloud_out.data.resize(0);
        cloud_out.data.resize(cloud_out.row_step);
        cloud_out.is_bigendian = false;
        cloud_out.is_dense     = false;
        for (std::size_t i = 0; i < kept_.size(); ++i)
        {
            const std::uint32_t at    = kept_[i];
            const double        range = scan_in.ranges[at];
            unsigned char *     point = &cloud_out.data[i * cloud_out.point_step];
            put(point, 0, static_cast<float>(range * rays_[at].x));
            put(point, 1, static_cast<float>(range * rays_[at].y));
            std::size_t field = 3; // z is 0, and so is the viewpoint
            for (const int option : {channel_option::Intensity, channel_option::Index, channel_option::Distance,
                                     channel_option::Timestamp})
            {
                if (!has(scan_in, channel_options, option))
                {
                    continue;
                }
                if (option == channel_option::Index)
                {
                    sensor_msgs::writePointCloud2BufferValue<Field::INT32>(point + 4 * field, at);
                }
                else
                {
                    put(point, field, value_of(scan_in, option, at));
                }
                ++field;
            }
        }
    }

    // A laser that moves: each ray is turned and moved as the laser was then. Throw what lookupTransform throws.
    void transformLaserScanToPointCloud(const std::string &target_frame, const sensor_msgs::LaserScan &scan_in,
                                        sensor_msgs::PointCloud &cloud_out, tf::Transformer &tf, double range_cutoff,
                                        int channel_options = channel_option::Default)
    {
        projectLaser(scan_in, cloud_out, range_cutoff, channel_options);
        cloud_out.header.frame_id = target_frame.c_str();
        const Motion motion       = motion_of(target_frame, scan_in, tf);
        for (std::size_t i = 0; i < kept_.size(); ++i)
        {
            const double       ratio = kept_[i] / (static_cast<double>(scan_in.ranges.size()) - 1.0);
            auto &             point = cloud_out.points[i];
            const tf2::Vector3 moved = motion.at(ratio) * tf2::Vector3(point.x, point.y, point.z);
            point.x                  = static_cast<float>(moved.x());
            point.y                  = static_cast<float>(moved.y());
            point.z                  = static_cast<float>(moved.z());
        }
    }
    void transformLaserScanToPointCloud(const std::string &target_frame, const sensor_msgs::LaserScan &scan_in,
                                        sensor_msgs::PointCloud &cloud_out, tf::Transformer &tf,
                                        int channel_options = channel_option::Default)
    {
        transformLaserScanToPointCloud(target_frame, scan_in, cloud_out, tf, -1.0, channel_options);
    }
    void transformLaserScanToPointCloud(const std::string &target_frame, const sensor_msgs::LaserScan &scan_in,
                                        sensor_msgs::PointCloud2 &cloud_out, tf::Transformer &tf,
                                        double range_cutoff = -1.0, int channel_options = channel_option::Default)
    {
        const Motion motion = motion_of(target_frame, scan_in, tf);
        project_moving(target_frame, scan_in, cloud_out, motion, range_cutoff, channel_options);
    }
    void transformLaserScanToPointCloud(const std::string &target_frame, const sensor_msgs::LaserScan &scan_in,
                                        sensor_msgs::PointCloud2 &cloud_out, tf2::BufferCore &tf,
                                        double range_cutoff = -1.0, int channel_options = channel_option::Default)
    {
        const std::string frame(scan_in.header.frame_id.c_str());
        const Motion      motion(tf.lookupTransform(target_frame, frame, scan_in.header.stamp),
                                 tf.lookupTransform(target_frame, frame, end_of(scan_in)));
        project_moving(target_frame, scan_in, cloud_out, motion, range_cutoff, channel_options);
    }
    // Where the target frame moves, too: as it is when the scan begins, seen from a frame that does not move.
    void transformLaserScanToPointCloud(const std::string &target_frame, const sensor_msgs::LaserScan &scan_in,
                                        sensor_msgs::PointCloud2 &cloud_out, const std::string &fixed_frame,
                                        tf2::BufferCore &tf, double range_cutoff = -1.0,
                                        int channel_options = channel_option::Default)
    {
        const std::string frame(scan_in.header.frame_id.c_str());
        const ros::Time   begin = scan_in.header.stamp;
        const Motion      motion(tf.lookupTransform(target_frame, begin, frame, begin, fixed_frame),
                                 tf.lookupTransform(target_frame, begin, frame, end_of(scan_in), fixed_frame));
        project_moving(target_frame, scan_in, cloud_out, motion, range_cutoff, channel_options);
    }

  private:
    typedef sensor_msgs::PointField Field;

    struct Ray
    {
        double x, y;
    };

    // Where the laser is while it scans: it goes evenly from one place to another.
    struct Motion
    {
        Motion(const tf2::Quaternion &from_turn, const tf2::Vector3 &from, const tf2::Quaternion &to_turn,
               const tf2::Vector3 &to)
            : turns{from_turn, to_turn}, places{from, to}
        {
        }
        Motion(const geometry_msgs::TransformStamped &from, const geometry_msgs::TransformStamped &to)
            : Motion(turn_of(from.transform.rotation), place_of(from.transform.translation),
                     turn_of(to.transform.rotation), place_of(to.transform.translation))
        {
        }

        static tf2::Quaternion turn_of(const geometry_msgs::Quaternion &q)
        {
            return tf2::Quaternion(q.x, q.y, q.z, q.w);
        }
        static tf2::Vector3 place_of(const geometry_msgs::Vector3 &v) { return tf2::Vector3(v.x, v.y, v.z); }

        tf2::Transform at(double ratio) const
        {
            tf2::Transform made;
            tf2::Vector3   place(0, 0, 0);
            place.setInterpolate3(places[0], places[1], ratio);
            made.setOrigin(place);
            made.setRotation(turns[0].slerp(turns[1], ratio));
            return made;
        }

        tf2::Quaternion turns[2];
        tf2::Vector3    places[2];
    };

    static bool has(const sensor_msgs::LaserScan &scan, int options, int option)
    {
        return (options & option) != 0 && (option != channel_option::Intensity || scan.intensities.size() > 0);
    }

    static const char *name_of(int option)
    {
        switch (option)
        {
            case channel_option::Intensity:
                return "intensity";
            case channel_option::Index:
                return "index";
            case channel_option::Distance:
                return "distances";
            default:
                return "stamps";
        }
    }

    static float value_of(const sensor_msgs::LaserScan &scan, int option, std::uint32_t at)
    {
        switch (option)
        {
            case channel_option::Intensity:
                return at < scan.intensities.size() ? scan.intensities[at] : 0;
            case channel_option::Index:
                return static_cast<float>(at);
            case channel_option::Distance:
                return scan.ranges[at];
            default:
                return static_cast<float>(at) * scan.time_increment;
        }
    }

    static void add_field(sensor_msgs::PointCloud2 &cloud, const char *name, int datatype = Field::FLOAT32)
    {
        cloud.fields.emplace_back();
        cloud.fields.back().name     = name;
        cloud.fields.back().datatype = static_cast<std::uint8_t>(datatype);
        cloud.fields.back().offset   = cloud.point_step;
        cloud.fields.back().count    = 1;
        cloud.point_step += 4;
    }

    static void put(unsigned char *point, std::size_t field, float value)
    {
        sensor_msgs::writePointCloud2BufferValue<Field::FLOAT32>(point + 4 * field, value);
    }
    static tf2::Vector3 vector_at(const unsigned char *at)
    {
        return tf2::Vector3(sensor_msgs::readPointCloud2BufferValue<Field::FLOAT32, double>(at),
                            sensor_msgs::readPointCloud2BufferValue<Field::FLOAT32, double>(at + 4),
                            sensor_msgs::readPointCloud2BufferValue<Field::FLOAT32, double>(at + 8));
    }
    static void put(unsigned char *at, const tf2::Vector3 &vector)
    {
        put(at, 0, static_cast<float>(vector.x()));
        put(at, 1, static_cast<float>(vector.y()));
        put(at, 2, static_cast<float>(vector.z()));
    }

    // When the last ray was sent.
    static ros::Time end_of(const sensor_msgs::LaserScan &scan)
    {
        const double last = scan.ranges.empty() ? 0 : static_cast<double>(scan.ranges.size() - 1);
        return scan.header.stamp + ros::Duration(static_cast<float>(last) * scan.time_increment);
    }

    static Motion motion_of(const std::string &target_frame, const sensor_msgs::LaserScan &scan, tf::Transformer &tf)
    {
        const std::string    frame(scan.header.frame_id.c_str());
        tf::StampedTransform ends[2];
        tf.lookupTransform(target_frame, frame, scan.header.stamp, ends[0]);
        tf.lookupTransform(target_frame, frame, end_of(scan), ends[1]);
        tf2::Quaternion turns[2];
        tf2::Vector3    places[2];
        for (int i = 0; i < 2; ++i)
        {
            tf::Quaternion turn;
            ends[i].getBasis().getRotation(turn);
            turns[i]  = tf2::Quaternion(turn.x(), turn.y(), turn.z(), turn.w());
            places[i] = tf2::Vector3(ends[i].getOrigin().x(), ends[i].getOrigin().y(), ends[i].getOrigin().z());
        }
        return Motion(turns[0], places[0], turns[1], places[1]);
    }

    void project_moving(const std::string &target_frame, const sensor_msgs::LaserScan &scan,
                        sensor_msgs::PointCloud2 &cloud, const Motion &motion, double range_cutoff, int options)
    {
        projectLaser(scan, cloud, range_cutoff, options);
        cloud.header.frame_id = target_frame.c_str();
        const double each     = 1 / (static_cast<double>(scan.ranges.size()) - 1.0);
        for (std::size_t i = 0; i < kept_.size(); ++i)
        {
            unsigned char *      point = &cloud.data[i * cloud.point_step];
            const tf2::Transform then  = motion.at(kept_[i] * each);
            put(point, then * vector_at(point));
            if ((options & channel_option::Viewpoint) != 0) // the last fields
            {
                put(point + cloud.point_step - 12, then * tf2::Vector3(0, 0, 0));
            }
        }
    }

    // Which rays are kept, and where all of them point.
    void keep(const sensor_msgs::LaserScan &scan, double range_cutoff)
    {
        const std::size_t count = scan.ranges.size();
        if (rays_.size() != count || angle_min_ != scan.angle_min || angle_increment_ != scan.angle_increment)
        {
            rays_.resize(count);
            angle_min_       = scan.angle_min;
            angle_increment_ = scan.angle_increment;
            for (std::size_t i = 0; i < count; ++i)
            {
                const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
                rays_[i]           = {std::cos(angle), std::sin(angle)};
            }
        }
        kept_.clear();
        kept_.reserve(count);
        const double below = range_cutoff < 0 ? scan.range_max : range_cutoff;
        for (std::size_t i = 0; i < count; ++i)
        {
            if (scan.ranges[i] < below && scan.ranges[i] >= scan.range_min)
            {
                kept_.push_back(static_cast<std::uint32_t>(i));
            }
        }
    }

    std::vector<Ray>           rays_;
    std::vector<std::uint32_t> kept_;
    float                      angle_min_       = 0;
    float                      angle_increment_ = 0;
};

} // namespace laser_geometry

#endif
