// A transform at an instant, with the numbers of its frames.
#ifndef TF2_TRANSFORM_STORAGE_H
#define TF2_TRANSFORM_STORAGE_H

#include <geometry_msgs/TransformStamped.h>

#include "ros/time.h"
#include "roscfe/frames/buffer.h"
#include "tf2/LinearMath/Quaternion.h"
#include "tf2/LinearMath/Vector3.h"

namespace tf2
{

typedef roscfe::frames::FrameId CompactFrameID;

class TransformStorage
{
  public:
    TransformStorage() = default;
    TransformStorage(const geometry_msgs::TransformStamped &data, CompactFrameID frame_id, CompactFrameID child_frame_id)
        : rotation_(data.transform.rotation.x, data.transform.rotation.y, data.transform.rotation.z,
                    data.transform.rotation.w),
          translation_(data.transform.translation.x, data.transform.translation.y, data.transform.translation.z),
          stamp_(data.header.stamp),
          frame_id_(frame_id),
          child_frame_id_(child_frame_id)
    {
    }

    Quaternion     rotation_;
    Vector3        translation_;
    ros::Time      stamp_;
    CompactFrameID frame_id_       = 0;
    CompactFrameID child_frame_id_ = 0;
};

} // namespace tf2

#endif
