// Words for compilers that ROS's headers have for their users.
#ifndef ROSCFE_ROS_MACROS_H
#define ROSCFE_ROS_MACROS_H

#define ROS_DEPRECATED __attribute__((deprecated))
#define ROS_FORCE_INLINE inline __attribute__((always_inline))
#define ROS_HELPER_IMPORT
#define ROS_HELPER_EXPORT
#define ROS_HELPER_LOCAL

#endif
