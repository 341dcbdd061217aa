// Prints what tf2_geometry_msgs, tf2/utils.h and tf/transform_datatypes.h make of numbers on the standard input.
// Compiled against the headers of cfepy or those of a real ROS.
#include <cstdio>

#include <tf2/utils.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

static double n[32];

template <class V>
static void put(const char *name, const V &v)
{
    std::printf(" %s %a %a %a", name, v.x, v.y, v.z);
}
static void put(const char *name, const geometry_msgs::Quaternion &q)
{
    std::printf(" %s %a %a %a %a", name, q.x, q.y, q.z, q.w);
}
template <class Message>
static void stamped(const Message &message)
{
    std::printf(" %u.%u %s\n", message.header.stamp.sec, message.header.stamp.nsec, message.header.frame_id.c_str());
}

// A message of any type, with a header, through a transform.
template <class Message>
static Message through(const geometry_msgs::TransformStamped &transform, Message message)
{
    message.header.stamp    = ros::Time(1, 2);
    message.header.frame_id = "from";
    Message out;
    tf2::doTransform(message, out, transform);
    return out;
}

static void print_all(const geometry_msgs::TransformStamped &t)
{
    geometry_msgs::PoseWithCovarianceStamped pose;
    geometry_msgs::Vector3Stamped            vector;
    geometry_msgs::PointStamped              point;
    geometry_msgs::QuaternionStamped         turn;
    geometry_msgs::PoseStamped               plain;
    geometry_msgs::WrenchStamped             wrench;
    geometry_msgs::TransformStamped          transform;
    pose.pose.pose.position.x    = n[7];
    pose.pose.pose.position.y    = n[8];
    pose.pose.pose.position.z    = n[9];
    pose.pose.pose.orientation.x = n[10];
    pose.pose.pose.orientation.y = n[11];
    pose.pose.pose.orientation.z = n[12];
    pose.pose.pose.orientation.w = n[13];
    for (int at = 0; at < 36; ++at)
        pose.pose.covariance[at] = n[at % 31] * (at + 1);
    plain.pose      = pose.pose.pose;
    turn.quaternion = plain.pose.orientation;
    point.point     = plain.pose.position;
    vector.vector.x = wrench.wrench.torque.y = n[14];
    vector.vector.y = wrench.wrench.force.z = n[15];
    vector.vector.z = wrench.wrench.force.x = n[16];
    transform.transform.translation = vector.vector;
    transform.transform.rotation    = turn.quaternion;

    put("vector", through(t, vector).vector), stamped(through(t, vector));
    put("point", through(t, point).point), stamped(through(t, point));
    put("turn", through(t, turn).quaternion), stamped(through(t, turn));
    put("position", through(t, plain).pose.position);
    put("orientation", through(t, plain).pose.orientation), stamped(through(t, plain));
    put("force", through(t, wrench).wrench.force);
    put("torque", through(t, wrench).wrench.torque), stamped(through(t, wrench));
    put("translation", through(t, transform).transform.translation);
    put("rotation", through(t, transform).transform.rotation), stamped(through(t, transform));
    for (double each : through(t, pose).pose.covariance)
        std::printf("covariance %a\n", each);
    put("pose", through(t, pose).pose.pose.position), stamped(through(t, pose));

    double yaw, pitch, roll;
    tf2::getEulerYPR(turn.quaternion, yaw, pitch, roll);
    std::printf("angles %a %a %a %a\n", yaw, pitch, roll, tf2::getYaw(turn));

    tf2::Stamped<tf2::Transform> typed;
    geometry_msgs::PoseStamped   back;
    tf2::fromMsg(plain, typed);
    tf2::toMsg(typed, back);
    put("back", back.pose.orientation), stamped(back);
    put("identity", tf2::getTransformIdentity<geometry_msgs::Transform>().rotation);
    std::printf("\n");
}

int main()
{
    for (;;)
    {
        for (double &each : n)
            if (std::scanf("%la", &each) != 1)
                return 0;
        geometry_msgs::TransformStamped t;
        t.header.stamp            = ros::Time(7, 8);
        t.header.frame_id         = "to";
        t.child_frame_id          = "from";
        t.transform.translation.x = n[0];
        t.transform.translation.y = n[1];
        t.transform.translation.z = n[2];
        t.transform.rotation.x    = n[3];
        t.transform.rotation.y    = n[4];
        t.transform.rotation.z    = n[5];
        t.transform.rotation.w    = n[6];
        print_all(t);
    }
}
